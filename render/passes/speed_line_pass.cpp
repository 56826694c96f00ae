#include "render/passes/speed_line_pass.h"

#include "ecs/base/log.h"
#include "render/gpu/shader_library.h"

namespace limn {

void draw_speed_lines(
    FrameGraph& graph, gpu::Device& device, SpeedLinePass& pass, const FrameScene& scene,
    TextureId radiance, const Gbuffer& gbuffer) {
    if (pass.count > 0 && pass.program == nullptr && !pass.failed) {
        const Result<const gpu::Program*> made =
            device.shaders().load({.vertex = "speed_line.vert", .fragment = "speed_line.frag"});
        pass.failed = !made;
        if (made) {
            pass.program = *made;
        } else {
            log_error("{}", made.error().message);
        }
    }
    if (pass.count == 0 || pass.program == nullptr) {
        return;
    }
    graph.add_pass(
        "speed lines", {depth_tested(gbuffer.depth)}, {radiance},
        [&pass, &scene](PassContext& context) {
            gpu::Device& its_device = context.device();
            its_device.use(gpu::Pipeline{
                pass.program,
                {.depth = {.write = false}, .blend = gpu::kBlendPremultiplied, .cull = GL_NONE}});
            bind_view(its_device, scene);
            pass.records.bind(its_device, 0);
            its_device.draw_ids(6 * pass.count);
        });
}

}  // namespace limn
