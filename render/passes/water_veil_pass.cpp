#include "render/passes/water_veil_pass.h"

namespace limn {

namespace {

constexpr unsigned kRadianceUnit = 0;
constexpr unsigned kSceneDepthUnit = 5;
constexpr std::uint32_t kOceanKey = 1u << 30;  ///< beside those of lighting_key

}  // namespace

Result<WaterVeilPass> create_water_veil_pass(gpu::Device& device) {
    return WaterVeilPass{SurfacePrograms(device, "fullscreen.vert", "water_veil.frag")};
}

TextureId draw_water_veil(
    FrameGraph& graph, WaterVeilPass& pass, const WaterSurfaces& waters, const FrameScene& scene,
    TextureId radiance, const Gbuffer& gbuffer) {
    const std::optional<WaterAroundView>& around = waters.list.around;
    if (!around) {
        return radiance;
    }
    const TextureId veiled = graph.create(
        {.name = "radiance under water",
         .format = scene.radiance_format,
         .width = scene.view.width,
         .height = scene.view.height});
    const std::vector<Use> reads = lighting_reads(scene, {radiance, gbuffer.depth});
    const Use writes[] = {cleared(veiled)};
    graph.add_pass(
        "water veil", std::span<const Use>(reads), std::span<const Use>(writes),
        [&pass, &waters, &scene, around = *around, radiance, gbuffer](PassContext& context) {
            std::vector<gpu::ShaderDefine> defines = lighting_defines(scene);
            const bool ocean = !waters.seas.empty();
            if (ocean) {
                defines.push_back({"OCEAN"});
            }
            const gpu::Program* const program =
                pass.veil.get(0, lighting_key(scene) | (ocean ? kOceanKey : 0), defines);
            if (program == nullptr) {
                return;
            }
            gpu::Device& device = context.device();
            device.use(gpu::Pipeline{program, gpu::kFullscreenState});
            program->set("body", around.body);
            program->set("at_surface", around.at_surface ? 1 : 0);
            bind_lighting(device, scene);
            bind_water_surfaces(device, waters);
            context.bind_texture(kRadianceUnit, radiance);
            context.bind_texture(kSceneDepthUnit, gbuffer.depth);
            device.draw_fullscreen();
        });
    return veiled;
}

}  // namespace limn
