#include "content/load/motion/motion_scene.h"

#include "content/load/motion/bone_figure.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <filesystem>
#include <utility>

// Techniques: char.skeleton-hierarchy

namespace limn {
namespace {

/// The skeleton below a first joint with this name.
SkeletonData below_scene(const std::string& name, const SkeletonData& skeleton) {
    SkeletonData below = skeleton;
    below.name = name;
    below.joints.insert(below.joints.begin(), name);
    below.parents.insert(below.parents.begin(), -1);
    for (std::size_t j = 1; j < below.parents.size(); ++j) {
        ++below.parents[j];
    }
    below.rest.translations.insert(below.rest.translations.begin(), Vec3(0));
    below.rest.rotations.insert(below.rest.rotations.begin(), Quat(1, 0, 0, 0));
    below.rest.scales.insert(below.rest.scales.begin(), Vec3(1));
    for (JointFreedom& freedom : below.freedoms) {
        ++freedom.joint;
    }
    return below;
}

/// The clip for joints of that skeleton.
ClipData below_scene(ClipData clip) {
    for (ClipSheet& sheet : clip.sheets) {
        for (auto* list : {&sheet.rotating, &sheet.translating, &sheet.scaling}) {
            for (std::uint16_t& joint : *list) {
                ++joint;
            }
        }
    }
    for (ClipContact& contact : clip.contacts) {
        ++contact.joint;
    }
    return clip;
}

/// At rest the root is where the clip begins, so that a view of the rest pose shows the motion.
void start_at_first_key(const ClipData& clip, SkeletonData& skeleton) {
    for (const ClipSheet& sheet : clip.sheets) {
        const bool moves_root = !sheet.translating.empty() && sheet.translating[0] == 1;
        if (moves_root && sheet.interpolation != Interpolation::Cubic) {
            skeleton.rest.translations[1] = sheet.translations[0];
        }
    }
}

void add_joint_nodes(GltfScene& scene) {
    const SkeletonData& skeleton = scene.skeleton;
    const auto first = static_cast<std::int32_t>(scene.nodes.size());
    for (std::size_t j = 1; j < skeleton.joints.size(); ++j) {
        GltfNode& node = scene.nodes.emplace_back();
        node.name = skeleton.joints[j];
        node.parent = skeleton.parents[j] == 0 ? -1 : first + skeleton.parents[j] - 1;
        node.transform.position = skeleton.rest.translations[j];
        node.transform.rotation = skeleton.rest.rotations[j];
        node.transform.scale = skeleton.rest.scales[j];
        scene.joints.push_back(static_cast<std::int32_t>(j));
    }
}

}  // namespace

GltfScene make_motion_scene(const std::string& name, const SkeletonMotion& motion) {
    GltfScene scene;
    scene.name = name;
    scene.skeleton = below_scene(name, motion.skeleton);
    const ClipData clip = below_scene(motion.clip);
    start_at_first_key(clip, scene.skeleton);
    add_joint_nodes(scene);
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
        scene.clips.push_back(clip);
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
