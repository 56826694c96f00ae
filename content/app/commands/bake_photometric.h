#pragma once

#include "ecs/base/result.h"

namespace limn {

struct BakeOptions;

/// `limn bake photometric SHOTS.json -o NAME.png`: NAME_normal.png and NAME_albedo.png of
/// photographs, each under one light; see photometric_normals.h.
Status bake_photometric(const BakeOptions& options);

}  // namespace limn
