#include "render/particles/particle_layer.h"

#include "render/fullscreen.h"
#include "render/gpu/device.h"
#include "render/shaders/particle_gpu.h"
#include "render/view_block.h"

#include <algorithm>

// Techniques: particle.half-resolution

namespace limn {
namespace {

/// Sets the scissor to the window in the layer's pixels, with a border that filters read.
void set_layer_scissor(gpu::Device& device, const LightBounds& window) {
    constexpr int kBorder = 2;
    const int x = std::max(window.x / 2 - kBorder, 0);
    const int y = std::max(window.y / 2 - kBorder, 0);
    device.set_scissor(
        x, y, window.x / 2 + window.width / 2 + 2 * kBorder - x,
        window.y / 2 + window.height / 2 + 2 * kBorder - y);
}

}  // namespace

Result<ParticleLayerPrograms> create_particle_layer_programs(gpu::Device& device) {
    return ParticleLayerPrograms{
        LIMN_TRY(load_fullscreen(device, "particle_layer_depth.frag")),
        LIMN_TRY(load_fullscreen(device, "particle_layer.frag"))};
}

ParticleLayer begin_particle_layer(
    FrameGraph& graph, const ParticleLayerPrograms& programs, ViewData& view,
    const LightBounds& window) {
    const IVec2 size = half_resolution(view.size());
    const ParticleLayer layer = {
        window, create_target(graph, "particles.layer depth", GL_DEPTH_COMPONENT32F, size),
        create_target(graph, "particles.layer", view.frame->radiance_format, size)};
    graph.add_pass(
        "particles.layer depth", {sampled(view.gbuffer.depth, layout::kParticleDepthUnit)},
        {discarded(layer.depth)}, [&programs, window](PassContext& context) {
            set_layer_scissor(context.device(), window);
            context.device().use(
                gpu::Pipeline{programs.shrink, {.depth = {.func = GL_ALWAYS}, .cull = GL_NONE}});
            context.device().draw_fullscreen();
            context.device().disable_scissor();
        });
    return layer;
}

void end_particle_layer(
    FrameGraph& graph, const ParticleLayerPrograms& programs, const ParticleLayer& layer,
    ViewData& view) {
    graph.add_pass(
        "particles.enlarge",
        {sampled(layer.radiance, layout::kParticleLayerUnit),
         sampled(layer.depth, layout::kParticleLayerDepthUnit),
         sampled(view.gbuffer.depth, layout::kParticleDepthUnit)},
        {view.radiance}, [&programs, &view, window = layer.window](PassContext& context) {
            context.device().set_scissor(window.x, window.y, window.width, window.height);
            gpu::PipelineState state = gpu::kFullscreenState;
            state.blend = gpu::kBlendPremultiplied;
            context.device().use(gpu::Pipeline{programs.enlarge, state});
            bind_view(context, view);
            context.device().draw_fullscreen();
            context.device().disable_scissor();
        });
}

}  // namespace limn
