#include "content/load/motion/motion_take.h"

#include "content/load/files/json_document.h"
#include "content/load/gltf/gltf_load.h"
#include "content/load/gltf/gltf_write.h"
#include "content/load/motion/bvh_export.h"
#include "content/load/motion/htr_file.h"
#include "content/load/motion/motion_scene.h"
#include "content/load/motion/motion_text.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <vector>

namespace limn {
namespace {

bool has_extension(const std::string& path, std::string_view extension) {
    return equals_ignoring_case(std::filesystem::path(path).extension().string(), extension);
}

Result<GltfScene> load_take_scene(const std::string& path, const BvhImport& bvh) {
    if (has_extension(path, ".bvh")) {
        return load_bvh_scene(path, bvh);
    }
    if (has_extension(path, ".htr")) {
        const SkeletonMotion motion = LIMN_TRY(load_htr(path));
        return make_motion_scene(motion.skeleton.name, motion);
    }
    if (has_extension(path, ".glb") || has_extension(path, ".gltf")) {
        return load_gltf(path);
    }
    return fail("{}: format not supported, expected .bvh, .htr, .gltf or .glb", path);
}

}  // namespace

Result<MotionTake>
load_motion_take(const std::string& path, const std::string& clip, const BvhImport& bvh) {
    MotionTake take;
    take.scene = LIMN_TRY(load_take_scene(path, bvh));
    if (take.scene.skeleton.joints.empty()) {
        return fail("{}: found no joints, expected a skeleton", path);
    }
    if (!clip.empty()) {
        const auto found = std::ranges::find(take.scene.clips, clip, &ClipData::name);
        if (found == take.scene.clips.end()) {
            std::vector<std::string_view> names;
            for (const ClipData& known : take.scene.clips) {
                names.emplace_back(known.name);
            }
            return fail(
                "{}: found no clip {}, expected one of {}{}", path, in_quotes(clip),
                join_text(names, ", "), did_you_mean(clip, names));
        }
        take.clip = static_cast<std::size_t>(found - take.scene.clips.begin());
    }
    return take;
}

Status save_motion_take(const std::string& path, const MotionTake& take) {
    if (has_extension(path, ".bvh")) {
        return save_bvh(path, take.motion());
    }
    if (has_extension(path, ".glb")) {
        return save_glb(path, take.scene);
    }
    return fail("{}: expected a file name ending in .glb or .bvh", path);
}

}  // namespace limn
