#include "render/lens/temporal_pass.h"

#include "ecs/components/rendering.h"
#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/shaders/fullscreen_gpu.h"
#include "render/shaders/temporal_gpu.h"
#include "render/view_block.h"

// Techniques: post.temporal
// Source of post.temporal: Karis 2014; Salvi 2016
// Shown by `limn play gallery --antialiasing none`: post.temporal

namespace limn {
namespace {

gpu::Texture make_history(std::string_view label, GLenum format, const TextureSpec& size) {
    gpu::Texture texture(label, {.format = format, .width = size.width, .height = size.height});
    texture.clear(Vec4(0));
    return texture;
}

}  // namespace

Result<TemporalEffect> TemporalEffect::create(gpu::Device& device, const RenderSettings&) {
    return TemporalEffect{LIMN_TRY(load_fullscreen(device, "temporal.frag"))};
}

bool TemporalEffect::is_used(const FrameData& frame) {
    const auto* rendering = frame.world->find_resource<Rendering>();
    return frame.kind == kCameraView && rendering != nullptr
           && rendering->antialiasing == Antialiasing::Temporal;
}

void TemporalEffect::collect(FrameData& frame) {
    since_cut = frame.since_last ? since_cut + 1 : 0;
    frame.camera =
        with_jitter(frame.camera, sample_jitter(since_cut % kTemporalSamples, kTemporalSamples));
    frame.velocity = true;
}

void TemporalEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    LIMN_CHECK(view.gbuffer.velocity.valid());
    const TextureSpec spec = graph.spec(view.radiance);
    bool has_history = last_frame + 1 == frame.number && frame.since_last.has_value();
    for (int i = 0; i < 2; ++i) {
        const bool fits = history[i] && history[i].width() == spec.width
                          && history[i].height() == spec.height
                          && history[i].desc().format == spec.format;
        if (!fits) {
            history[i] = make_history("temporal history", spec.format, spec);
            moments[i] = make_history("temporal moments", GL_RG32F, spec);
            has_history = false;
        }
    }
    const TextureId before = graph.import("temporal.history", history[newest]);
    const TextureId moments_before = graph.import("temporal.previous moments", moments[newest]);
    newest = 1 - newest;
    last_frame = frame.number;
    const TextureId resolved = graph.import("temporal", history[newest]);
    const TextureId moments_now = graph.import("temporal.moments", moments[newest]);
    add_fullscreen_pass(
        graph, "temporal",
        {sampled(view.radiance, layout::kSourceUnit), sampled(before, layout::kHistoryUnit),
         sampled(view.gbuffer.velocity, layout::kTemporalVelocityUnit),
         sampled(view.gbuffer.depth, layout::kTemporalDepthUnit),
         sampled(moments_before, layout::kMomentsUnit)},
        {discarded(resolved), discarded(moments_now)}, program,
        [&view, has_history](PassContext& context, const gpu::Program& shader) {
            bind_view(context, view);
            shader.set("has_history", has_history ? 1 : 0);
        });
    view.radiance = resolved;
}

}  // namespace limn
