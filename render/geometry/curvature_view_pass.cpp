#include "render/geometry/curvature_view_pass.h"

#include "ecs/world.h"
#include "render/geometry/surface_draws.h"
#include "render/gpu/device.h"
#include "render/settings.h"
#include "render/view_block.h"

#include <array>
#include <vector>

// Techniques: relief.curvature-view

namespace limn {
namespace {

/// With what curved relief needs of vertices.
Variant curved_vertices() {
    Variant variant;
    variant.add("RELIEF_MAP", 0);
    variant.add("RELIEF_CURVED");
    return variant;
}

}  // namespace

bool CurvatureViewEffect::is_used(const FrameData& frame) {
    return frame.world->find_resource<CurvatureView>() != nullptr;
}

Result<CurvatureViewEffect>
CurvatureViewEffect::create(gpu::Device& device, const RenderSettings&) {
    CurvatureViewEffect effect{ProgramVariants::of_meshes(device, "curvature_view.frag")};
    LIMN_TRY(effect.programs.load(curved_vertices()));
    return effect;
}

void CurvatureViewEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    const auto* found = frame.world->find_resource<CurvatureView>();
    if (found == nullptr) {
        return;
    }
    const std::vector<Use> reads = mesh_reads(graph, frame, {depth_tested(view.gbuffer.depth)});
    graph.add_pass(
        "curvature", reads, std::array{Use(view.radiance)},
        [this, &view, shown = within_ranges(*found)](PassContext& context) {
            const auto& list = view.data.get<InstanceList>();
            bind_view(context, view);
            bind_instances(context.device(), *view.frame, list);
            for (const DrawRun& run : list.opaque) {
                const gpu::Program* program =
                    run.features.has(kDeformed)
                        ? nullptr
                        : programs.get(curved_vertices(), moving_features(run.features));
                if (program != nullptr) {
                    context.device().use(gpu::Pipeline{
                        program,
                        visible_sides({.depth = {.write = false, .func = GL_GEQUAL}}, run)});
                    const bool tangent = shown.axis == CurvatureAxis::Tangent;
                    program->set("axis", tangent ? Vec2(1, 0) : Vec2(0, 1));
                    program->set("full", shown.full);
                    draw_run(context.device(), *view.frame, list, run);
                }
            }
        });
}

}  // namespace limn
