#include "render/passes/aov_pass.h"

#include "render/gpu/shader_library.h"
#include "render/render_frame.h"

#include <string>
#include <vector>

namespace limn {

const std::array<Aov, kAovCount> kAovs = {{
    {"depth", 1, {kNoDepth, 0, 0, 0}},
    {"normal", 3, {0, 0, 0, 0}},
    {"albedo", 3, {0, 0, 0, 0}},
    {"velocity", 2, {0, 0, 0, 0}},
    {"emission", 3, {0, 0, 0, 0}},
    {"shadow_texels", 1, {0, 0, 0, 0}},
    {"volume_layers", 1, {0, 0, 0, 0}},
}};

namespace {
constexpr int kVelocityAov = 3;
constexpr int kShadowTexelsAov = 5;
}  // namespace

Result<AovPass> create_aov_pass(gpu::Device& device) {
    AovPass pass;
    for (int i = 0; i < kVolumeLayersAov; ++i) {
        const Result<const gpu::Program*> program = device.shaders().load(
            {.vertex = "fullscreen.vert",
             .fragment = "aov.frag",
             .defines = {{"AOV", std::to_string(i)}}});
        if (!program) {
            return program.error();
        }
        pass.programs[i] = *program;
    }
    return pass;
}

TextureId draw_aov(
    FrameGraph& graph, const AovPass& pass, const FrameScene& scene, const Gbuffer& gbuffer,
    int aov) {
    const std::string name = "aov." + std::string(kAovs[aov].name);
    const TextureId value = graph.create(
        {.name = name,
         .format = GL_RGBA32F,
         .width = scene.view.width,
         .height = scene.view.height});
    std::vector<Use> reads = {gbuffer.surface, depth_tested(gbuffer.depth)};
    if (aov == kVelocityAov) {
        reads.emplace_back(gbuffer.velocity);
    }
    const Use writes[] = {cleared(value, kAovs[aov].nothing)};
    graph.add_pass(
        name, std::span<const Use>(reads), std::span<const Use>(writes),
        [&pass, &scene, gbuffer, aov](PassContext& context) {
            const auto shadow_views = static_cast<int>(scene.shadows.records.size());
            if (aov == kShadowTexelsAov && shadow_views == 0) {
                return;
            }
            // The sky moves, too; it has nothing else.
            gpu::PipelineState state = gpu::kFullscreenState;
            if (aov != kVelocityAov) {
                state.depth = {.test = true, .write = false, .func = GL_LESS};
            }
            context.device().use(gpu::Pipeline{pass.programs[aov], state});
            bind_view(context.device(), scene);
            context.bind_texture(kGbufferUnit, gbuffer.surface);
            context.bind_texture(kDepthUnit, gbuffer.depth);
            if (aov == kVelocityAov) {
                context.bind_texture(kVelocityUnit, gbuffer.velocity);
            }
            if (aov == kShadowTexelsAov) {
                scene.shadow_views->bind(context.device(), kShadowViewsUnit);
                pass.programs[aov]->set("shadow_view_count", shadow_views);
            }
            context.device().draw_fullscreen();
        });
    return value;
}

}  // namespace limn
