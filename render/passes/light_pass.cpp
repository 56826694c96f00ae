#include "render/passes/light_pass.h"

#include "render/gpu/shader_library.h"

namespace limn {
namespace {

/// The triangle of fullscreen.vert lies at depth 0: less than a surface's, equal to nothing's.
gpu::PipelineState full_screen_where(GLenum depth_func) {
    return {.depth = {.test = true, .write = false, .func = depth_func}, .cull = GL_NONE};
}

}  // namespace

Result<LightPass> create_light_pass(gpu::Device& device) {
    LightPass pass = {.lights = SurfacePrograms(device, "fullscreen.vert", "light_pass.frag")};
    const Status plain = pass.lights.load(0, 0, {});
    if (!plain) {
        return plain.error();
    }
    for (int kind = 0; kind < kSkyKinds; ++kind) {
        const Result<const gpu::Program*> sky = device.shaders().load(
            {.vertex = "fullscreen.vert",
             .fragment = "sky.frag",
             .defines = {{"SKY_KIND", std::to_string(kind)}}});
        if (!sky) {
            return sky.error();
        }
        pass.sky[kind] = *sky;
    }
    return pass;
}

TextureId
draw_lights(FrameGraph& graph, LightPass& pass, const FrameScene& scene, const Gbuffer& gbuffer) {
    const TextureId radiance = graph.create(
        {.name = "radiance",
         .format = scene.radiance_format,
         .width = scene.view.width,
         .height = scene.view.height});
    const std::vector<Use> reads =
        lighting_reads(scene, {gbuffer.surface, depth_tested(gbuffer.depth)});
    const Use writes[] = {cleared(radiance)};
    graph.add_pass(
        "lights", std::span<const Use>(reads), std::span<const Use>(writes),
        [&pass, &scene, gbuffer](PassContext& context) {
            const gpu::Program* program =
                pass.lights.get(0, lighting_key(scene), lighting_defines(scene));
            if (program == nullptr) {
                return;
            }
            context.device().use(gpu::Pipeline{program, full_screen_where(GL_LESS)});
            bind_lighting(context.device(), scene);
            context.bind_texture(kGbufferUnit, gbuffer.surface);
            context.bind_texture(kDepthUnit, gbuffer.depth);
            bind_shadow_masks(context, scene);
            context.device().draw_fullscreen();
        });
    return radiance;
}

TextureId draw_sky(
    FrameGraph& graph, const LightPass& pass, const FrameScene& scene, TextureId radiance,
    const Gbuffer& gbuffer) {
    if (scene.environment.settings.visible || scene.for_light) {
        graph.add_pass(
            "sky", {depth_tested(gbuffer.depth)}, {radiance},
            [&pass, &scene](PassContext& context) {
                const auto kind = static_cast<int>(scene.environment.settings.sky);
                context.device().use(gpu::Pipeline{pass.sky[kind], full_screen_where(GL_EQUAL)});
                bind_view(context.device(), scene);
                const gpu::RingSlice& block = scene.environment_block;
                context.device().bind_uniforms(
                    kEnvironmentBinding, block.buffer, block.offset, block.size);
                if (scene.environment.settings.sky == SkyKind::Panorama) {
                    context.device().bind_texture(kGbufferUnit, *scene.environment.cube);
                }
                pass.sky[kind]->set("for_light", scene.for_light ? 1 : 0);
                context.device().draw_fullscreen();
            });
    }
    return radiance;
}

}  // namespace limn
