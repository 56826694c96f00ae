#pragma once

#include "ecs/base/result.h"

namespace limn {

struct BakeOptions;

// Shown by `limn bake motion take.bvh -o clean.glb --set cutoff=8 --set loop=true`:
//     char.mocap-cleanup
// Shown by `limn bake motion take.trc body.glb --recipe markers.json -o take.glb`:
//     char.marker-to-joint
// Shown by `limn bake motion take.htr -o take.glb`: char.htr-format
// Shown by `limn bake motion walk.bvh -o walk.glb --set travel=true`: char.walk-retarget
// Shown by `limn bake retarget walk.bvh person.glb -o walking.glb`: char.retarget-body

/// Cleans up recorded motion.
[[nodiscard]] Status bake_motion(const BakeOptions& options);

/// Gives a motion to another body.
[[nodiscard]] Status bake_retarget(const BakeOptions& options);

}  // namespace limn
