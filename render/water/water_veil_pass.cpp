#include "render/water/water_veil_pass.h"

#include "ecs/world.h"
#include "render/gpu/device.h"
#include "render/light/lighting.h"
#include "render/shaders/fullscreen_gpu.h"
#include "render/shaders/water_gpu.h"
#include "render/water/water_surfaces.h"

namespace limn {
namespace {}  // namespace

bool WaterVeilEffect::is_used(const FrameData& frame) {
    return !frame.world->query<const Water>().empty();
}

Result<WaterVeilEffect> WaterVeilEffect::create(gpu::Device& device, const RenderSettings&) {
    return WaterVeilEffect{ProgramVariants::fullscreen(device, "water_veil.frag")};
}

void WaterVeilEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    const auto* waters = view.data.find<WaterSurfaces>();
    if (waters == nullptr || !waters->list.around) {
        return;
    }
    const TextureId veiled = create_radiance(graph, view, "radiance under water");
    const std::vector<Use> reads = lighting_reads(
        view, {sampled(view.radiance, layout::kSourceUnit),
               sampled(view.gbuffer.depth, layout::kWaterVeilDepthUnit)});
    const Use writes[] = {cleared(veiled)};
    graph.add_pass(
        "water veil", std::span(reads), writes,
        [this, waters, &view, around = *waters->list.around](PassContext& context) {
            Variant variant = view.lighting.variant;
            variant.add_if(waters->any_seas(), "OCEAN");
            const gpu::Program* program = veil.get(variant);
            if (program == nullptr) {
                return;
            }
            gpu::Device& device = context.device();
            device.use(gpu::Pipeline{program, gpu::kFullscreenState});
            program->set("body", around.body);
            program->set("at_surface", around.at_surface ? 1 : 0);
            bind_lighting(context, view);
            bind_water_surfaces(device, *waters);
            device.draw_fullscreen();
        });
    view.radiance = veiled;
}

}  // namespace limn
