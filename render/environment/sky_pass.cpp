#include "render/environment/sky_pass.h"

#include "render/environment/environment_maps.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/light/lighting.h"
#include "render/shaders/environment_gpu.h"
#include "render/view_block.h"

#include <string>
#include <vector>

namespace limn {

Result<SkyEffect> SkyEffect::create(gpu::Device& device, const RenderSettings&) {
    SkyEffect effect;
    for (int kind = 0; kind < kSkyKinds; ++kind) {
        effect.programs[kind] = LIMN_TRY(device.shaders().load(
            {.vertex = "fullscreen.vert",
             .fragment = "sky.frag",
             .defines = {{"SKY_KIND", std::to_string(kind)}}}));
    }
    return effect;
}

void SkyEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    const auto& environment = frame.data.get<SceneEnvironment>();
    const bool for_light = !view.is(kMainViews);  // without the sun, which lights by itself
    if (!environment.settings.visible && !for_light) {
        return;
    }
    std::vector<Use> reads = {depth_tested(view.gbuffer.depth)};
    if (environment.sky != nullptr) {
        reads.push_back(sampled(graph.import("sky map", *environment.sky), layout::kSkyCubeUnit));
    }
    const Use writes[] = {view.radiance};
    graph.add_pass(
        "sky", reads, writes,
        [program = programs[static_cast<int>(environment.settings.sky)], &view, &environment,
         for_light](PassContext& context) {
            const gpu::RingSlice& block = environment.block_slice;
            context.device().use(gpu::Pipeline{program, kWhereBackground});
            bind_view(context, view);
            context.device().bind_uniforms(
                layout::kEnvironmentBinding, block.buffer, block.offset, block.size);
            program->set("for_light", for_light ? 1 : 0);
            context.device().draw_fullscreen();
        });
}

}  // namespace limn
