#pragma once

#include "ecs/base/result.h"

namespace limn {

struct BakeOptions;

/// `limn bake strain_model POSES.json -o NAME.exr`: the wrinkles of captured normal maps, one for
/// each expression of a face, as a function of its skin's strain (wrinkle_model.h), for the
/// wrinkle texture of the method `model`.
Status bake_strain_model(const BakeOptions& options);

}  // namespace limn
