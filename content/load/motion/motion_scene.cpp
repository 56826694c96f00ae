#include "content/load/motion/motion_scene.h"

#include "content/load/gltf/gltf_skeleton.h"
#include "content/load/motion/bone_figure.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <filesystem>
#include <utility>

// Techniques: char.skeleton-hierarchy

namespace limn {
namespace {

/// At rest the root is where the clip begins, so that a view of the rest pose shows the motion.
void start_at_first_key(const ClipData& clip, SkeletonData& skeleton) {
    for (const ClipSheet& sheet : clip.sheets) {
        const bool moves_root = !sheet.translating.empty() && sheet.translating[0] == 0;
        if (moves_root && sheet.interpolation != Interpolation::Cubic) {
            skeleton.rest.translations[0] = sheet.translations[0];
        }
    }
}

}  // namespace

GltfScene make_motion_scene(const std::string& name, const SkeletonMotion& motion) {
    GltfScene scene;
    scene.name = name;
    SkeletonData skeleton = motion.skeleton;
    start_at_first_key(motion.clip, skeleton);
    add_skeleton(scene, name, skeleton);
    BoneFigure figure = make_bone_figure(scene.skeleton);
    if (!figure.meshes.empty()) {
        GltfNode& node = scene.nodes.emplace_back();
        node.name = "bones";
        node.skin = 0;
        for (std::uint32_t m = 0; m < figure.meshes.size(); ++m) {
            node.parts.push_back({m, m});
        }
        scene.joints.push_back(-1);
        scene.meshes = std::move(figure.meshes);
        scene.materials = std::move(figure.materials);
        scene.skins.push_back(std::move(figure.skin));
    }
    if (!motion.clip.sheets.empty()) {
        scene.clips.push_back(below_scene(motion.clip));
    }
    return scene;
}

Result<GltfScene>
load_bvh_scene(const std::string& path, const BvhImport& options, const LoadOptions& load) {
    const BvhFile bvh = LIMN_TRY(load_bvh(path));
    const std::string name = std::filesystem::path(path).stem().string();
    const Result<SkeletonMotion> motion = make_bvh_motion(bvh, name, options);
    if (!motion) {
        return fail("{}: {}", path, motion.error().message);
    }
    GltfScene scene = make_motion_scene(name, *motion);
    scene.warnings = bvh.warnings;
    LIMN_TRY(report_load_warnings(path, scene.warnings, load));
    return scene;
}

}  // namespace limn
