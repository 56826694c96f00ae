#include "render/gpu/embedded_shaders.h"
#include "render/material/shading_models.h"

#include <iterator>

namespace limn::gpu {

const GeneratedShader kGeneratedShaders[] = {
    {"generated/model_numbers.glsl", model_numbers_glsl},
    {"generated/model_functions.glsl", model_functions_glsl},
};
const unsigned kGeneratedShaderCount = std::size(kGeneratedShaders);

}  // namespace limn::gpu
