#include "render/passes/blend_pass.h"

#include "render/instance_list.h"
#include "render/lighting.h"
#include "render/surface_draws.h"
#include "render/view_block.h"

namespace limn {

Result<BlendEffect> BlendEffect::create(gpu::Device& device, const RenderSettings&) {
    BlendEffect effect{ProgramVariants::of_meshes(device, "blend.frag")};
    LIMN_TRY(effect.programs.load());
    return effect;
}

void BlendEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    if (view.data.get<InstanceList>().blended.empty()) {
        return;
    }
    const std::vector<Use> reads =
        mesh_reads(graph, *view.frame, lighting_reads(view, {depth_tested(view.gbuffer.depth)}));
    const Use writes[] = {view.radiance};
    graph.add_pass("blended", std::span(reads), writes, [this, &view](PassContext& context) {
        const bool clipped = is_clipped(view);
        Variant variant = view.lighting.variant;
        variant.add_if(clipped, "CLIPPED");
        bind_lighting(context, view);
        draw_runs(
            context, view, view.data.get<InstanceList>().blended, programs,
            {.variant = &variant,
             .state = {
                 .depth = {.write = false}, .blend = gpu::kBlendPremultiplied, .clip = clipped}});
    });
}

}  // namespace limn
