#include "render/passes/blend_pass.h"

namespace limn {

namespace {

constexpr std::uint32_t kClippedKey = 1u << 31;  ///< beside those of lighting_key

}  // namespace

Result<BlendPass> create_blend_pass(gpu::Device& device) {
    BlendPass pass = {SurfacePrograms(device, "mesh.vert", "blend.frag")};
    const Status plain = pass.programs.load(0, 0, {});
    if (!plain) {
        return plain.error();
    }
    return pass;
}

TextureId draw_blended(
    FrameGraph& graph, BlendPass& pass, const FrameScene& scene, TextureId radiance,
    const Gbuffer& gbuffer) {
    if (!scene.instances.blended.empty()) {
        const std::vector<Use> reads = lighting_reads(scene, {depth_tested(gbuffer.depth)});
        const Use writes[] = {radiance};
        graph.add_pass(
            "blended", std::span<const Use>(reads), std::span<const Use>(writes),
            [&pass, &scene](PassContext& context) {
                bind_lighting(context.device(), scene);
                const bool clipped = is_clipped(scene);
                std::vector<gpu::ShaderDefine> defines = lighting_defines(scene);
                if (clipped) {
                    defines.push_back({"CLIPPED"});
                }
                draw_runs(
                    context.device(), scene, scene.instances.blended, pass.programs, 0,
                    lighting_key(scene) | (clipped ? kClippedKey : 0), defines,
                    {.depth = {.write = false},
                     .blend = gpu::kBlendPremultiplied,
                     .clip = clipped});
            });
    }
    return radiance;
}

}  // namespace limn
