#pragma once

#include "ecs/components/surface.h"

#include <string_view>

namespace limn {

/// Whether the shading model (shading_models.h) reads the material's field: surfaces that are lit
/// with it may look different with another value. The fields that all models read are not listed.
[[nodiscard]] bool reads_field(ShadingModel model, std::string_view field);

}  // namespace limn
