#include "render/passes/sky_pass.h"

#include "render/environment_maps.h"
#include "render/fullscreen.h"
#include "render/gpu/shader_library.h"
#include "render/lighting.h"
#include "render/view_block.h"

#include <string>

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
    add_fullscreen_pass(
        graph, "sky", {depth_tested(view.gbuffer.depth)}, {view.radiance},
        programs[static_cast<int>(environment.settings.sky)], kWhereBackground,
        [&view, &environment, for_light](PassContext& context, const gpu::Program& program) {
            gpu::Device& device = context.device();
            const gpu::RingSlice& block = environment.block_slice;
            bind_view(context, view);
            device.bind_uniforms(kEnvironmentBinding, block.buffer, block.offset, block.size);
            if (environment.settings.sky == SkyKind::Panorama) {
                device.bind_texture(kGbufferUnit, *environment.cube);
            }
            program.set("for_light", for_light ? 1 : 0);
        });
}

}  // namespace limn
