#include "render/skinning/deform_pass.h"

#include "ecs/base/log.h"
#include "render/geometry/mesh_pool.h"
#include "render/gpu/shader_library.h"
#include "render/render_frame.h"
#include "render/shaders/deform_gpu.h"

#include <algorithm>
#include <string>

// Techniques: char.skin-gpu

namespace limn {
namespace {

/// Binds the range of a stream that holds the vertices of a batch.
void bind_stream(
    gpu::Device& device, unsigned binding, const gpu::Buffer& buffer, const DeformBatch& batch,
    std::size_t stride) {
    device.bind_storage(
        binding, buffer.id(), batch.first_vertex * stride,
        (batch.end_vertex - batch.first_vertex) * stride);
}

/// The flags of a job depend on whether its shape changed in this frame and in the previous one.
/// Lists all variants that may occur for jobs that are otherwise equal.
std::vector<std::uint32_t> flags_of_later_frames(std::uint32_t flags, bool with_previous) {
    constexpr std::uint32_t kCurrent = layout::kDeformCurrent;
    constexpr std::uint32_t kPrevious = layout::kDeformPrevious;
    constexpr std::uint32_t kCopy = layout::kDeformCopyPrevious;
    const std::uint32_t shape = flags & ~(kCurrent | kPrevious | kCopy);
    if (!with_previous) {
        return {shape | kCurrent};
    }
    return {
        shape | kPrevious, shape | kCopy, shape | kCurrent | kCopy, shape | kCurrent,
        shape | kCurrent | kPrevious};
}

Result<const gpu::Program*> load_program(gpu::Device& device, std::uint32_t flags) {
    return device.shaders().load(
        {.compute = "deform.comp", .defines = {{"DEFORM_FLAGS", std::to_string(flags)}}});
}

const gpu::Program* program_of(gpu::Device& device, DeformPass& pass, std::uint32_t flags) {
    const auto [found, fresh] = pass.programs.try_emplace(flags, nullptr);
    if (fresh) {
        const Result<const gpu::Program*> program = load_program(device, flags);
        if (program) {
            found->second = *program;
        } else {
            log_error("{}", program.error().message);
        }
    }
    return found->second;
}

void run_batch(
    gpu::Device& device, DeformPass& pass, const DeformedVertices& vertices,
    const DeformBatch& batch, std::uint32_t flags) {
    const gpu::Program* program = program_of(device, pass, flags);
    if (program == nullptr) {
        return;
    }
    device.use(*program);
    const gpu::Buffer& previous =
        vertices.previous_positions() ? vertices.previous_positions() : vertices.positions();
    bind_stream(device, layout::kDeformPositionsBinding, vertices.positions(), batch, sizeof(Vec3));
    bind_stream(device, layout::kDeformPreviousBinding, previous, batch, sizeof(Vec3));
    bind_stream(
        device, layout::kDeformFramesBinding, vertices.frames(), batch, sizeof(PackedFrame));
    program->set("first_group", batch.first_group);
    program->set("group_count", batch.group_count);
    program->set("first_vertex", batch.first_vertex);
    const unsigned wide = std::min(batch.group_count, layout::kDeformGroupsWide);
    device.dispatch(wide, (batch.group_count + wide - 1) / wide);
}

}  // namespace

Result<DeformPass> create_deform_pass(gpu::Device& device) {
    LIMN_TRY(load_program(device, layout::kDeformCurrent | layout::kDeformJoints));
    return DeformPass{};
}

void deform_meshes(FrameGraph& graph, DeformPass& pass, DeformedList& shapes, bool warm_up) {
    const DeformWork& work = shapes.work();
    if (work.batches.empty()) {
        return;
    }
    pass.jobs.set(work.jobs);
    pass.groups.set(work.groups);
    pass.rest.set(shapes.rest().texels());
    pass.palettes.set(work.palettes);
    pass.weights.set(work.weights);
    pass.controls.set(work.controls);
    const DeformedVertices& vertices = shapes.vertices();
    std::vector<Use> writes;
    for (const BufferId buffer : import_deformed(graph, vertices)) {
        writes.emplace_back(buffer);
    }
    graph.add_pass("deform", {}, writes, [&pass, &shapes, warm_up](PassContext& context) {
        gpu::Device& device = context.device();
        pass.jobs.bind(device, layout::kDeformJobsUnit);
        pass.groups.bind(device, layout::kDeformGroupJobsUnit);
        pass.rest.bind(device, layout::kDeformRestUnit);
        pass.palettes.bind(device, layout::kDeformPalettesUnit);
        pass.weights.bind(device, layout::kDeformWeightsUnit);
        pass.controls.bind(device, layout::kDeformControlsUnit);
        for (const DeformBatch& batch : shapes.work().batches) {
            if (warm_up) {
                const bool previous{shapes.vertices().previous_positions()};
                for (const std::uint32_t flags : flags_of_later_frames(batch.flags, previous)) {
                    run_batch(device, pass, shapes.vertices(), batch, flags);
                }
            }
            run_batch(device, pass, shapes.vertices(), batch, batch.flags);
        }
    });
}

Result<DeformEffect> DeformEffect::create(gpu::Device& device, const RenderSettings&) {
    return DeformEffect{LIMN_TRY(create_deform_pass(device))};
}

void DeformEffect::draw_shared(FrameGraph& graph, const FrameData& frame) {
    frame.shapes->write_jobs(*frame.ring);
    deform_meshes(graph, pass, *frame.shapes, frame.warm_up);
}

void DeformEffect::report(const FrameData& frame, const ViewData&, FrameOutput& out) {
    out.statistics.deformed = frame.shapes->work().instances;
}

}  // namespace limn
