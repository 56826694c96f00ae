#pragma once

#include "content/bake/motion/skeleton_motion.h"
#include "content/load/gltf/gltf_scene.h"
#include "ecs/base/result.h"

#include <cstddef>
#include <string>
#include <vector>

namespace limn {

// Views of a motion that stand still: its poses at equal time steps on top of each other, the
// earlier ones fainter, with the trails of joints (char.ghost-view). Where a joint is fast, its
// ghosts are far apart.

struct GhostOptions {
    float begin = 0.0f;                    ///< [s]
    float end = 0.0f;                      ///< [s]; 0: that of the clip
    float step = 0.1f;                     ///< from ghost to ghost [s], > 0
    std::vector<std::string> trails = {};  ///< joints
    std::string highlight = {};            ///< a joint whose bones are yellow in all ghosts
};

/// Times of the ghosts: floor((end - begin) / step) + 1 of them.
[[nodiscard]] std::vector<float> ghost_times(float duration, const GhostOptions& options);

/// Opacity of a ghost, 0 .. 1: the earlier the fainter. `ghost` < `count` counts from the earliest.
[[nodiscard]] float ghost_opacity(std::size_t ghost, std::size_t count);

/// A scene without joints. Fails with one line on an unknown joint and on more than 1000 ghosts.
[[nodiscard]] Result<GltfScene> make_ghost_scene(
    const std::string& name, const SkeletonMotion& motion, const GhostOptions& options);

}  // namespace limn
