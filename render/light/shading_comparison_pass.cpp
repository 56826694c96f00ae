#include "render/light/shading_comparison_pass.h"

#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/light/lighting.h"
#include "render/settings.h"
#include "render/shaders/shading_comparison_gpu.h"

// Techniques: fakephong.metric-diffimage

namespace limn {

bool ShadingComparisonEffect::is_used(const FrameData& frame) {
    return frame.world->find_resource<ShadingComparison>() != nullptr;
}

Result<ShadingComparisonEffect>
ShadingComparisonEffect::create(gpu::Device& device, const RenderSettings&) {
    return ShadingComparisonEffect{LIMN_TRY(load_fullscreen(device, "shading_comparison.frag"))};
}

void ShadingComparisonEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    const auto* both = view.data.find<ComparedRadiance>();
    if (both == nullptr) {
        return;
    }
    const TextureId composed = create_like(graph, "radiance of both", view.radiance);
    const auto* found = frame.world->find_resource<ShadingComparison>();
    add_fullscreen_pass(
        graph, "shading comparison",
        {sampled(both->left, layout::kLeftRadianceUnit),
         sampled(both->right, layout::kRightRadianceUnit)},
        {discarded(composed)}, program,
        [comparison = within_ranges(*found)](PassContext&, const gpu::Program& to) {
            to.set("shows_difference", comparison.image == ComparisonImage::Difference ? 1 : 0);
            to.set("divider", comparison.divider);
            to.set("gain", comparison.gain);
            to.set("exponent", comparison.exponent);
        });
    view.radiance = composed;
}

}  // namespace limn
