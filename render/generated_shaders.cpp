#include "render/gpu/embedded_shaders.h"
#include "render/material/shading_models.h"
#include "render/material/surface_hooks.h"

#include <iterator>

namespace limn::gpu {

const GeneratedShader kGeneratedShaders[] = {
    {"generated/model_numbers.glsl", model_numbers_glsl},
    {"generated/model_functions.glsl", model_functions_glsl},
    {"generated/position_hooks.glsl", position_hooks_glsl},
    {"generated/vertex_hooks.glsl", vertex_hooks_glsl},
    {"generated/surface_hooks.glsl", surface_hooks_glsl},
};
const unsigned kGeneratedShaderCount = std::size(kGeneratedShaders);

}  // namespace limn::gpu
