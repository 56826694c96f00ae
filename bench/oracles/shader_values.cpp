#include "bench/oracles/shader_values.h"

#include "render/gpu/buffer.h"
#include "render/gpu/shader_library.h"

#include <cstddef>

namespace limn::oracle {

Result<std::vector<Vec4>> evaluate_shader(
    gpu::Device& device, const std::string& before, const std::string& body,
    std::span<const Vec4> inputs) {
    gpu::ShaderFiles files = gpu::ShaderFiles::standard();
    files.put(
        "eval.comp", "#version 450\nlayout(local_size_x = 64) in;\n"
                     "layout(std430, binding = 0) readonly buffer Inputs { vec4 inputs[]; };\n"
                     "layout(std430, binding = 1) writeonly buffer Outputs { vec4 outputs[]; };\n"
                         + before
                         + "\nvoid main() {\n"
                           "    uint i = gl_GlobalInvocationID.x;\n"
                           "    if (i >= uint(inputs.length())) { return; }\n"
                           "    vec4 x = inputs[i];\n    vec4 y = vec4(0.0);\n"
                         + body + "\n    outputs[i] = y;\n}\n");
    gpu::ShaderLibrary library(device.caps(), files);
    const gpu::Program* const program = LIMN_TRY(library.load({.compute = "eval.comp"}));
    const gpu::Buffer source = gpu::Buffer::of("inputs", inputs);
    const gpu::Buffer target("outputs", inputs.size_bytes(), gpu::BufferUse::GpuOnly);
    device.use(*program);
    device.bind_storage(0, source);
    device.bind_storage(1, target);
    device.dispatch(static_cast<unsigned>((inputs.size() + 63) / 64));
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    std::vector<Vec4> outputs(inputs.size());
    target.read(0, std::as_writable_bytes(std::span(outputs)));
    device.invalidate_state();
    return outputs;
}

}  // namespace limn::oracle
