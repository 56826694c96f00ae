#include "render/geometry/tangent_frames_pass.h"

#include "ecs/world.h"
#include "render/geometry/surface_draws.h"
#include "render/gpu/device.h"
#include "render/settings.h"
#include "render/view_block.h"

#include <array>
#include <vector>

// Techniques: bump.frame-view

namespace limn {
namespace {

float axis_length(const FrameData& frame) {
    const auto* found = frame.world->find_resource<TangentFrames>();
    return found != nullptr ? within_ranges(*found).length : 0.0f;
}

}  // namespace

bool TangentFramesEffect::is_used(const FrameData& frame) {
    return axis_length(frame) > 0;
}

Result<TangentFramesEffect>
TangentFramesEffect::create(gpu::Device& device, const RenderSettings&) {
    TangentFramesEffect effect{ProgramVariants(
        device,
        {.vertex = "mesh.vert",
         .geometry = "tangent_frames.geom",
         .fragment = "tangent_frames.frag"},
        true)};
    LIMN_TRY(effect.programs.load());
    return effect;
}

void TangentFramesEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    const std::vector<Use> reads = mesh_reads(graph, frame, {depth_tested(view.gbuffer.depth)});
    graph.add_pass(
        "tangent frames", reads, std::array{Use(view.radiance)},
        [this, &view, length = axis_length(frame)](PassContext& context) {
            const auto& list = view.data.get<InstanceList>();
            bind_view(context, view);
            bind_instances(context.device(), *view.frame, list);
            for (const DrawRun& run : list.opaque) {
                const SurfaceFeatures features = moving_features(run.features);
                const gpu::Program* program = programs.get({}, features);
                if (program != nullptr) {
                    context.device().use(
                        gpu::Pipeline{program, {.depth = {.write = false}, .cull = GL_NONE}});
                    program->set("axis_length", length);
                    if (features.maps != MapUnits{}) {
                        view.frame->materials->bind_textures(run.textures);
                    }
                    draw_run(context.device(), *view.frame, list, run);
                }
            }
        });
}

}  // namespace limn
