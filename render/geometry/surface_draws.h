#pragma once

#include "render/frame_data.h"
#include "render/geometry/instance_list.h"
#include "render/light/light_objects.h"
#include "render/material/material_pool.h"
#include "render/material/surface_features.h"
#include "render/variant.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Draws the instances of a view, run by run: one multi-draw for all that share program, state and
// textures. The programs are variants of mesh.vert with the fragment shader of the pass.

/// What every run of a pass has in common.
struct SurfaceDraw {
    const Variant* variant = nullptr;  ///< of the programs, added to the surface's features
    std::uint32_t features = 0;        ///< of SurfaceFeature, added to those of the surface
    gpu::PipelineState state;          ///< winding and culled faces are set per run
    int light = -1;  ///< uniform light_index, if the programs shade a single light
};

void draw_runs(
    PassContext& context, const ViewData& view, std::span<const DrawRun> runs,
    ProgramVariants& programs, const SurfaceDraw& draw);

/// Draws the objects that single lights affect: `runs` of `commands`, indirect draw commands that
/// replace those of the instance list.
void draw_light_runs(
    PassContext& context, const ViewData& view, std::span<const LightRun> runs,
    const gpu::RingSlice& commands, ProgramVariants& programs, const SurfaceDraw& draw);

/// Draws runs of the view's instances for their depth alone, visible sides only.
void draw_depths(
    PassContext& context, const ViewData& view, std::span<const DrawRun> runs,
    ProgramVariants& programs);

/// Draws shadow casters for their depth alone, both sides: `programs` get only the features that
/// decide where a surface has holes.
void draw_casters(
    PassContext& context, const ViewData& view, const InstanceList& casters,
    ProgramVariants& programs, const gpu::PipelineState& state);

/// Draws the opaque instances with their current and previous positions, without their materials,
/// visible sides only; needs the view's velocity. `prepare(program)` sets the uniforms of each
/// program.
template <typename Prepare>
void draw_motions(
    PassContext& context, const ViewData& view, ProgramVariants& programs,
    const gpu::PipelineState& state, Prepare prepare);

/// Texture arrays with images that passes of this frame draw; published before the views are drawn.
struct DrawnImages {
    std::vector<const gpu::Texture*> arrays;
};

/// The same, for images that are computed from their previous states.
struct FeedbackImages {
    std::vector<const gpu::Texture*> arrays;
};

/// The same, for images that stacks of others are blended into.
struct LayeredImages {
    std::vector<const gpu::Texture*> arrays;
};

/// The same, for images that are lit texel by texel.
struct ShadedImages {
    std::vector<const gpu::Texture*> arrays;
};

/// The same, for normal maps that are composed of several.
struct WrinkledImages {
    std::vector<const gpu::Texture*> arrays;
};

/// What passes that call the functions above must declare: `reads`, the DrawnImages, the
/// FeedbackImages, the LayeredImages, the ShadedImages, the WrinkledImages and, if meshes are
/// deformed in this frame, their vertices.
[[nodiscard]] std::vector<Use>
mesh_reads(FrameGraph& graph, const FrameData& frame, std::vector<Use> reads = {});

// ---- parts of the above ----

/// The features of a surface that move the vertices of its mesh.
[[nodiscard]] SurfaceFeatures moving_features(const SurfaceFeatures& features);

/// Binds instance streams, material records and draw commands of a list.
void bind_instances(gpu::Device& device, const FrameData& frame, const InstanceList& list);
/// `state` with the face culling of a run.
[[nodiscard]] gpu::PipelineState visible_sides(gpu::PipelineState state, const DrawRun& run);
void draw_run(
    gpu::Device& device, const FrameData& frame, const InstanceList& list, const DrawRun& run);

template <typename Prepare>
void draw_motions(
    PassContext& context, const ViewData& view, ProgramVariants& programs,
    const gpu::PipelineState& state, Prepare prepare) {
    const auto& list = view.data.get<InstanceList>();
    bind_instances(context.device(), *view.frame, list);
    for (const DrawRun& run : list.opaque) {
        SurfaceFeatures features = moving_features(run.features);
        features.bits |= (run.features.bits & kDeformed) | kVelocity;
        const gpu::Program* program = programs.get({}, features);
        if (program != nullptr) {
            context.device().use(gpu::Pipeline{program, visible_sides(state, run)});
            prepare(*program);
            if (features.maps != MapUnits{}) {
                view.frame->materials->bind_textures(run.textures);
            }
            draw_run(context.device(), *view.frame, list, run);
        }
    }
}

}  // namespace limn
