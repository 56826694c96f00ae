#pragma once

#include "ecs/base/result.h"

namespace limn {

struct BakeOptions;

// Shown by `limn bake ghosts walk.bvh -o ghosts.glb --set highlight=LeftLeg`: char.ghost-view

/// The poses of a motion at equal time steps as one model, with trails of joints.
[[nodiscard]] Status bake_ghosts(const BakeOptions& options);

/// The rotation channels of a joint over time, as an SVG.
[[nodiscard]] Status bake_curves(const BakeOptions& options);

}  // namespace limn
