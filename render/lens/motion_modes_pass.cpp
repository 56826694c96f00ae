#include "render/lens/motion_modes_pass.h"

#include "render/fullscreen.h"
#include "render/geometry/surface_draws.h"
#include "render/shaders/fullscreen_gpu.h"
#include "render/shaders/motion_modes_gpu.h"
#include "render/view_block.h"

#include <algorithm>
#include <array>

// Techniques: post.motion-blur-accumulation, post.motion-blur-camera-psf,
//     post.motion-blur-optic-flow, post.motion-blur-stretch

namespace limn {
namespace {

void copy_frame(
    FrameGraph& graph, std::string_view name, const gpu::Program* copy, TextureId from, Use to) {
    add_fullscreen_pass(
        graph, name, {sampled(from, layout::kSourceUnit)}, {to}, copy,
        [](PassContext&, const gpu::Program& program) { program.set("weight", 1.0f); });
}

}  // namespace

// ---- accumulate ----

Result<MotionAccumulate> MotionAccumulate::create(gpu::Device& device) {
    return MotionAccumulate{
        LIMN_TRY(load_fullscreen(device, "accumulate.frag")),
        LIMN_TRY(load_fullscreen(device, "motion_accumulate.frag"))};
}

TextureId MotionAccumulate::blur(
    FrameGraph& graph, const MotionBlur& settings, const ViewData& view, bool follows) {
    const int window = std::clamp(settings.window, 1, 16);
    const IVec2 size = size_of(graph, view.radiance);
    const gpu::TextureDesc ring = {
        .format = GL_RGBA32F,
        .width = size.x,
        .height = size.y,
        .depth = window,
        .target = GL_TEXTURE_2D_ARRAY};
    const bool fits = frames && frames.desc() == ring;
    if (!fits) {
        frames = gpu::Texture("motion history", ring);
    }
    if (!fits || !follows) {
        newest = -1;
        count = 0;
    }
    newest = (newest + 1) % window;
    count = std::min(count + 1, window);

    const TextureId kept = graph.import("motion blur.frames", frames);
    copy_frame(
        graph, "motion blur, keep", copy, view.radiance, target_level(discarded(kept), 0, newest));
    const TextureId blurred = create_like(graph, "motion blur", view.radiance);
    add_fullscreen_pass(
        graph, "motion blur", {sampled(kept, layout::kSourceUnit)}, {discarded(blurred)}, mean,
        [window, newest = newest, count = count](PassContext&, const gpu::Program& program) {
            program.set("newest", newest);
            program.set("count", count);
            program.set("window", window);
        });
    return blurred;
}

// ---- camera ----

Result<MotionCamera> MotionCamera::create(gpu::Device& device) {
    return MotionCamera{LIMN_TRY(load_fullscreen(device, "motion_camera.frag"))};
}

TextureId
MotionCamera::blur(FrameGraph& graph, const MotionBlur& settings, const ViewData& view, bool) {
    const TextureId blurred = create_like(graph, "motion blur", view.radiance);
    add_fullscreen_pass(
        graph, "motion blur",
        {sampled(view.radiance, layout::kSourceUnit),
         sampled(view.gbuffer.depth, layout::kCameraMotionDepthUnit)},
        {discarded(blurred)}, program,
        [&view, settings](PassContext& context, const gpu::Program& shader) {
            bind_view(context, view);
            shader.set("half_exposure", half_exposure(settings));
            shader.set(
                "longest", 0.5f * settings.max_length * static_cast<float>(context.size().y));
            shader.set("samples", std::clamp(settings.samples, 4, 64));
        });
    return blurred;
}

// ---- flow ----

Result<MotionFlow> MotionFlow::create(gpu::Device& device) {
    MotionFlow flow = {
        ProgramVariants::of_meshes(device, "motion_flow_field.frag", "motion_flow.vert")};
    LIMN_TRY(flow.field.load({}, {.bits = kVelocity}));
    flow.warp = LIMN_TRY(load_fullscreen(device, "motion_flow.frag"));
    return flow;
}

TextureId
MotionFlow::blur(FrameGraph& graph, const MotionBlur& settings, const ViewData& view, bool) {
    constexpr int kSteps = 4;          // each half as long as the previous one
    constexpr float kTrailing = 1.0f;  // first step along the field, in halves of it
    constexpr float kLeading = 0.25f;  // the same against it

    const TextureId depth = view.gbuffer.depth;
    const TextureId flow =
        create_target(graph, "motion blur.flow", GL_RG16F, size_of(graph, depth));
    graph.add_pass(
        "motion blur, flow", mesh_reads(graph, *view.frame, {depth_tested(depth)}),
        std::array{cleared(flow)}, [this, &view, settings](PassContext& context) {
            bind_view(context, view);
            draw_motions(
                context, view, field, {.depth = {.write = false, .func = GL_EQUAL}},
                [&](const gpu::Program& program) {
                    program.set("exposure", 2.0f * half_exposure(settings));
                    program.set(
                        "longest", settings.max_length * static_cast<float>(context.size().y));
                });
        });
    TextureId image = view.radiance;
    float step = 0.5f;
    for (int i = 0; i < kSteps; ++i) {
        for (const float scale : {step * kTrailing, -step * kLeading}) {
            const TextureId mixed = create_like(graph, "motion blur", image);
            add_fullscreen_pass(
                graph, "motion blur",
                {sampled(image, layout::kSourceUnit), sampled(flow, layout::kFlowUnit)},
                {discarded(mixed)}, warp, [scale](PassContext&, const gpu::Program& program) {
                    program.set("scale", scale);
                });
            image = mixed;
        }
        step *= 0.5f;
    }
    return image;
}

// ---- stretch ----

Result<MotionStretch> MotionStretch::create(gpu::Device& device) {
    MotionStretch stretch = {
        ProgramVariants::of_meshes(device, "motion_stretch.frag", "motion_stretch.vert")};
    LIMN_TRY(stretch.hull.load({}, {.bits = kVelocity}));
    stretch.copy = LIMN_TRY(load_fullscreen(device, "accumulate.frag"));
    return stretch;
}

TextureId MotionStretch::blur(
    FrameGraph& graph, const MotionBlur& settings, const ViewData& view, bool follows) {
    const TextureSpec spec = graph.spec(view.radiance);
    const gpu::TextureDesc kept = {
        .format = spec.format, .width = spec.width, .height = spec.height};
    const bool fits = before && before.desc() == kept;
    if (!fits) {
        before = gpu::Texture("previous frame", kept);
    }
    const TextureId history = graph.import("motion blur.previous", before);
    if (!fits || !follows) {
        copy_frame(graph, "motion blur, first", copy, view.radiance, discarded(history));
    }
    const TextureId layer_depth =
        create_target(graph, "motion blur.depth", GL_DEPTH_COMPONENT32F, {spec.width, spec.height});
    const TextureId blurred = create_like(graph, "motion blur", view.radiance);
    copy_frame(graph, "motion blur, copy", copy, view.radiance, discarded(blurred));
    graph.add_pass(
        "motion blur",
        mesh_reads(
            graph, *view.frame,
            {sampled(view.radiance, layout::kStretchRadianceUnit),
             sampled(history, layout::kPreviousRadianceUnit),
             sampled(view.gbuffer.depth, layout::kStretchDepthUnit)}),
        std::array{Use(blurred), cleared(layer_depth)},
        [this, &view, settings](PassContext& context) {
            bind_view(context, view);
            draw_motions(context, view, hull, {}, [&](const gpu::Program& program) {
                program.set("samples", std::clamp(settings.samples, 2, 64));
                program.set("exposure", 2.0f * half_exposure(settings));
                program.set("longest", settings.max_length * static_cast<float>(context.size().y));
                program.set("with_camera", settings.with_camera ? 1 : 0);
            });
        });
    copy_frame(graph, "motion blur, keep", copy, view.radiance, discarded(history));
    return blurred;
}

}  // namespace limn
