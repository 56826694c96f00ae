#pragma once

#include "ecs/base/result.h"

namespace limn {

struct BakeOptions;

// Shown by `limn bake walk person -o walk.glb --set tiredness=0.5`: char.walk-control,
//     char.walk-cycle

/// A generated walk as a clip of a skeleton: that of a file, or of a generated model.
[[nodiscard]] Status bake_walk(const BakeOptions& options);

}  // namespace limn
