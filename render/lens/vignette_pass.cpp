#include "render/lens/vignette_pass.h"

#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/settings.h"
#include "render/shaders/fullscreen_gpu.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: post.effect-pipeline

namespace limn {
namespace {

Vignette vignette_of(const FrameData& frame) {
    const auto* found = frame.world->find_resource<Vignette>();
    return found != nullptr ? within_ranges(*found) : Vignette{};
}

}  // namespace

float vignette(const Vignette& settings, const Vec2& ndc, const Vec2& tangent) {
    const Vec2 offset = ndc * tangent;
    const float cos2 = 1 / (1 + glm::dot(offset, offset));
    const float natural = 1 + settings.natural * (cos2 * cos2 - 1);
    const float shift = settings.mechanical * glm::length(offset) / glm::length(tangent);
    const float d = std::clamp(shift, 0.0f, 1.0f);
    return natural * 2 / kPi * (std::acos(d) - d * std::sqrt(1 - d * d));
}

bool VignetteEffect::is_used(const FrameData& frame) {
    return vignette_of(frame) != Vignette{};
}

Result<VignetteEffect> VignetteEffect::create(gpu::Device& device, const RenderSettings&) {
    return VignetteEffect{LIMN_TRY(load_fullscreen(device, "vignette.frag"))};
}

void VignetteEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    const TextureId darkened = create_like(graph, "radiance with vignette", view.radiance);
    add_fullscreen_pass(
        graph, "vignette", {sampled(view.radiance, layout::kSourceUnit)}, {discarded(darkened)},
        program,
        [settings = vignette_of(frame),
         tangent = view.camera.tangent](PassContext&, const gpu::Program& shader) {
            shader.set("tangent", tangent);
            shader.set("natural", settings.natural);
            shader.set("mechanical", settings.mechanical);
        });
    view.radiance = darkened;
}

}  // namespace limn
