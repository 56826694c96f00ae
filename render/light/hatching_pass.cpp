#include "render/light/hatching_pass.h"

#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/light/hatched_view.h"
#include "render/settings.h"
#include "render/shaders/fullscreen_gpu.h"
#include "render/shaders/gbuffer_gpu.h"

// Techniques: tex.hatching
// Source of tex.hatching: Praun et al. 2001

namespace limn {
namespace {

Hatching hatching_of(const FrameData& frame) {
    const auto* found = frame.world->find_resource<Hatching>();
    return found != nullptr ? within_ranges(*found) : Hatching{.opacity = 0};
}

}  // namespace

bool HatchingEffect::is_used(const FrameData& frame) {
    return hatching_of(frame).opacity > 0;
}

Result<HatchingEffect> HatchingEffect::create(gpu::Device& device, const RenderSettings&) {
    return HatchingEffect{LIMN_TRY(load_fullscreen(device, "hatching.frag"))};
}

void HatchingEffect::collect(FrameData& frame) {
    frame.attributes = true;
}

bool HatchingEffect::prepare(const FrameData&, ViewData& view) {
    (void)view.data.publish<HatchedView>();
    return true;
}

void HatchingEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    const TextureId drawn = create_like(graph, "radiance with hatching", view.radiance);
    add_fullscreen_pass(
        graph, "hatching",
        {sampled(view.radiance, layout::kSourceUnit),
         sampled(view.gbuffer.surface, layout::kGbufferUnit),
         sampled(view.gbuffer.depth, layout::kDepthUnit)},
        {discarded(drawn)}, program,
        [settings = hatching_of(frame)](PassContext&, const gpu::Program& shader) {
            shader.set("ink", Vec4(settings.color, settings.opacity));
            shader.set("white", settings.white);
            shader.set("wash", settings.wash);
        });
    view.radiance = drawn;
}

}  // namespace limn
