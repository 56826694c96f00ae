#include "render/geometry/surface_draws.h"

#include "render/geometry/mesh_pool.h"
#include "render/geometry/render_items.h"
#include "render/gpu/device.h"
#include "render/light/lighting.h"
#include "render/material/fur_hook.h"
#include "render/material/material_pool.h"
#include "render/shaders/instance_gpu.h"
#include "render/shaders/material_gpu.h"
#include "render/shaders/relief_gpu.h"
#include "render/skinning/deformed_list.h"
#include "render/view_block.h"

// Techniques: engine.batching, engine.material-bind

namespace limn {
namespace {

/// Points the instance streams at this frame's part of the ring buffer.
void set_instance_streams(gpu::VertexArray& vertices, const InstanceList& list) {
    const GLuint id = vertices.id();
    glVertexArrayVertexBuffer(
        id, kInstanceStream, list.instances.buffer, static_cast<GLintptr>(list.instances.offset),
        sizeof(layout::InstanceRecord));
    glVertexArrayBindingDivisor(id, kInstanceStream, 1);
    // No program reads this stream when it is empty, but something must be bound.
    const gpu::RingSlice& previous = list.previous.size > 0 ? list.previous : list.instances;
    glVertexArrayVertexBuffer(
        id, kPreviousTransformStream, previous.buffer, static_cast<GLintptr>(previous.offset),
        sizeof(Affine));
    glVertexArrayBindingDivisor(id, kPreviousTransformStream, 1);
}

void draw_commands(
    gpu::Device& device, const FrameData& frame, const DrawRun& run, const gpu::RingSlice& commands,
    std::uint32_t first, std::uint32_t count) {
    const bool deformed = run.features.has(kDeformed);
    VertexStreams& streams =
        deformed ? frame.shapes->vertices().streams() : frame.meshes->streams();
    device.bind_vertex_array(streams.vertices());
    if (streams.has(VertexStream::Curvature)) {
        streams.curvatures().bind(device, layout::kCurvaturesUnit);
    }
    device.draw_indexed_indirect(
        GL_TRIANGLES, index_type(run.wide), commands.offset + first * sizeof(DrawCommand),
        static_cast<int>(count));
}

/// Draws a run for its depth: `programs` get only the features that move vertices or fragments, or
/// make holes.
void draw_depth(
    PassContext& context, const ViewData& view, const InstanceList& list, const DrawRun& run,
    ProgramVariants& programs, const gpu::PipelineState& state) {
    constexpr std::uint32_t kHoles = kAlphaMask | kUvMap | kUvMaps | kVertexColor;
    const bool holes = run.features.has(kAlphaMask);
    SurfaceFeatures features = moving_features(run.features);
    if (holes) {
        features.bits |= run.features.bits & kHoles;
        features.maps.add(run.features.maps, 1u << layout::kBaseColorSlot);
    }
    add_off_mesh_hooks(features, run.features);
    Variant variant;
    variant.add_if(state.clip, "CLIPPED");
    const gpu::Program* program = programs.get(variant, features);
    if (program == nullptr) {
        return;
    }
    context.device().use(gpu::Pipeline{program, state});
    if (features.maps != MapUnits{}) {
        view.frame->materials->bind_textures(run.textures);
    }
    draw_run(context.device(), *view.frame, list, run);
}

SurfaceFeatures program_features(SurfaceFeatures features, std::uint32_t more) {
    features.bits |= more;
    // Without velocity the program does not depend on whether vertices are deformed.
    features.bits &= features.has(kVelocity) ? ~0u : ~std::uint32_t{kDeformed};
    return features;
}

/// The program of a run, in use with its uniforms and textures; false if it does not compile.
bool use_run(
    gpu::Device& device, const ViewData& view, const DrawRun& run, ProgramVariants& programs,
    const SurfaceDraw& draw, int light) {
    static const Variant kNone{};
    const Variant& variant = draw.variant != nullptr ? *draw.variant : kNone;
    const gpu::Program* program =
        programs.get(variant, program_features(run.features, draw.features));
    if (program == nullptr) {
        return false;
    }
    device.use(gpu::Pipeline{program, visible_sides(draw.state, run)});
    if (light >= 0) {
        program->set("light_index", light);
    }
    view.frame->materials->bind_textures(run.textures);
    return true;
}

}  // namespace

std::vector<Use> mesh_reads(FrameGraph& graph, const FrameData& frame, std::vector<Use> reads) {
    const auto add_images = [&](const auto* images) {
        for (std::size_t i = 0; images != nullptr && i < images->arrays.size(); ++i) {
            reads.emplace_back(graph.import("images", *images->arrays[i]));
        }
    };
    add_images(frame.data.find<DrawnImages>());
    add_images(frame.data.find<FeedbackImages>());
    add_images(frame.data.find<LayeredImages>());
    add_images(frame.data.find<ShadedImages>());
    add_images(frame.data.find<WrinkledImages>());
    if (!frame.shapes->work().batches.empty()) {
        for (const BufferId buffer : import_deformed(graph, frame.shapes->vertices())) {
            reads.emplace_back(buffer);
        }
    }
    return reads;
}

SurfaceFeatures moving_features(const SurfaceFeatures& features) {
    SurfaceFeatures moving = {.bits = features.bits & kInflate};
    add_moving_hooks(moving, features);
    return moving;
}

void bind_instances(gpu::Device& device, const FrameData& frame, const InstanceList& list) {
    set_instance_streams(frame.meshes->streams().vertices(), list);
    set_instance_streams(frame.shapes->vertices().streams().vertices(), list);
    frame.materials->records().bind(device, layout::kMaterialsUnit);
    frame.items->furs().bind(device);
    device.bind_indirect(list.commands.buffer);
}

gpu::PipelineState visible_sides(gpu::PipelineState state, const DrawRun& run) {
    const bool both_sides = run.features.has(kDoubleSided) || is_fin(run.features);
    state.cull = static_cast<GLenum>(both_sides ? GL_NONE : run.mirrored ? GL_FRONT : GL_BACK);
    return state;
}

void draw_run(
    gpu::Device& device, const FrameData& frame, const InstanceList& list, const DrawRun& run) {
    draw_commands(device, frame, run, list.commands, run.first_command, run.command_count);
}

void draw_runs(
    PassContext& context, const ViewData& view, std::span<const DrawRun> runs,
    ProgramVariants& programs, const SurfaceDraw& draw) {
    if (runs.empty()) {
        return;
    }
    const auto& list = view.data.get<InstanceList>();
    bind_instances(context.device(), *view.frame, list);
    for (const DrawRun& run : runs) {
        if (use_run(context.device(), view, run, programs, draw, draw.light)) {
            draw_run(context.device(), *view.frame, list, run);
        }
    }
}

void draw_light_runs(
    PassContext& context, const ViewData& view, std::span<const LightRun> runs,
    const gpu::RingSlice& commands, ProgramVariants& programs, const SurfaceDraw& draw) {
    const auto& list = view.data.get<InstanceList>();
    bind_instances(context.device(), *view.frame, list);
    context.device().bind_indirect(commands.buffer);
    for (const LightRun& lit : runs) {
        const DrawRun& run = list.opaque[lit.run];
        if (use_run(context.device(), view, run, programs, draw, static_cast<int>(lit.light))) {
            draw_commands(
                context.device(), *view.frame, run, commands, lit.first_command, lit.command_count);
        }
    }
}

void draw_depths(
    PassContext& context, const ViewData& view, std::span<const DrawRun> runs,
    ProgramVariants& programs) {
    const auto& list = view.data.get<InstanceList>();
    bind_instances(context.device(), *view.frame, list);
    for (const DrawRun& run : runs) {
        draw_depth(
            context, view, list, run, programs, visible_sides({.clip = is_clipped(view)}, run));
    }
}

void draw_casters(
    PassContext& context, const ViewData& view, const InstanceList& casters,
    ProgramVariants& programs, const gpu::PipelineState& state) {
    bind_instances(context.device(), *view.frame, casters);
    for (const DrawRun& run : casters.opaque) {
        draw_depth(context, view, casters, run, programs, state);
    }
}

}  // namespace limn
