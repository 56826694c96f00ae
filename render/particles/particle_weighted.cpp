#include "render/particles/particle_weighted.h"

#include "render/fullscreen.h"
#include "render/gpu/device.h"
#include "render/shaders/particle_gpu.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: particle.weighted-blended
// Source of particle.weighted-blended: McGuire and Bavoil 2013

namespace limn {

WeightedLayers create_weighted_layers(FrameGraph& graph, const ViewData& view) {
    return {
        create_target(graph, "particles.sum", GL_RGBA32F, view.size()),
        create_target(graph, "particles.kept", GL_R16, view.size())};
}

Vec2 weight_range(const Bounds& bounds, const RenderView& view) {
    const Affine& camera = view.world_from_camera;
    const Vec3 forward = glm::normalize(transform_vector(camera, Vec3(0, 0, -1)));
    const float distance = glm::dot(center(bounds) - transform_point(camera, Vec3(0)), forward);
    const float radius = glm::dot(half_extent(bounds), glm::abs(forward));
    if (is_empty(bounds) || !std::isfinite(distance + radius)) {
        return {0, 0};  // all weigh the same
    }
    const float nearest = std::max(distance - radius, view.near);
    const float farthest = std::max(distance + radius, nearest);
    return {nearest, farthest > nearest ? 1 / (farthest - nearest) : 0};
}

void resolve_weighted(
    FrameGraph& graph, const gpu::Program& program, const WeightedLayers& layers, ViewData& view) {
    graph.add_pass(
        "particles.resolve",
        {sampled(layers.sum, layout::kWeightedSumUnit),
         sampled(layers.kept, layout::kWeightedKeptUnit)},
        {view.radiance}, [&program](PassContext& context) {
            gpu::PipelineState state = gpu::kFullscreenState;
            state.blend = gpu::kBlendPremultiplied;
            context.device().use(gpu::Pipeline{&program, state});
            context.device().draw_fullscreen();
        });
}

}  // namespace limn
