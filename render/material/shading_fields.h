#pragma once

#include "ecs/components/surface.h"

#include <string_view>

namespace limn {

/// Whether the shading model (shading_models.h) reads the material's field, that is, whether its
/// value can affect the look of a surface. Fields that all models read are not listed.
[[nodiscard]] bool reads_field(ShadingModel model, std::string_view field);

}  // namespace limn
