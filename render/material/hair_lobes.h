#pragma once

#include "ecs/components/surface.h"
#include "render/shaders/material_hair_gpu.h"

namespace limn {

// View-independent parameters of a material for lib/hair.glsl.
//
// Over the width of a strand, light leaves it at different azimuths, and rough strands spread it
// further by the logistic distribution of Chiang et al., "A Practical and Controllable Hair and Fur
// Model for Production Path Tracing" (2016). Both are replaced by a von Mises distribution with the
// same mean cosine.

[[nodiscard]] layout::HairBlock make_hair_block(const Material& material);

}  // namespace limn
