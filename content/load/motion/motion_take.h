#pragma once

#include "content/load/gltf/gltf_scene.h"
#include "content/load/motion/bvh_motion.h"
#include "ecs/base/result.h"

#include <string>

namespace limn {

// A motion of any file, and the scene to write it with: that of a glTF file, else a figure of
// bones.

struct MotionTake {
    GltfScene scene;
    std::size_t clip = 0;  ///< of the scene; none where the file has no motion

    [[nodiscard]] bool has_clip() const { return clip < scene.clips.size(); }
    [[nodiscard]] SkeletonMotion motion() const {
        return {scene.skeleton, has_clip() ? scene.clips[clip] : ClipData{}};
    }
};

/// Loads .bvh, .htr, .gltf or .glb. `clip`: of a glTF file, by name; "" is the first. Fails with
/// one line on other files, without joints and on an unknown clip.
[[nodiscard]] Result<MotionTake>
load_motion_take(const std::string& path, const std::string& clip = "", const BvhImport& bvh = {});

/// Writes .glb, or only the motion as .bvh.
[[nodiscard]] Status save_motion_take(const std::string& path, const MotionTake& take);

}  // namespace limn
