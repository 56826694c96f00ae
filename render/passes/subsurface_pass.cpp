#include "render/passes/subsurface_pass.h"

#include "ecs/components/surface.h"
#include "render/fullscreen.h"
#include "render/gpu/device.h"
#include "render/lighting.h"
#include "render/lobe_bounds.h"
#include "render/material_pool.h"
#include "render/shading_models.h"
#include "render/view_block.h"

#include <glm/common.hpp>

#include <string>

namespace limn {
namespace {

constexpr unsigned kScatteredUnit = 0;
constexpr unsigned kDistancesUnit = 1;
constexpr std::uint32_t kLobe = lobe_number(ShadingModel::Subsurface);

}  // namespace

Result<SubsurfaceEffect> SubsurfaceEffect::create(gpu::Device& device, const RenderSettings&) {
    const std::string lobe = std::to_string(kLobe);
    return SubsurfaceEffect{
        .program = LIMN_TRY(load_fullscreen(
            device, "subsurface.frag", {{"MATERIAL_RECORDS"}, {"SHADING_LOBE", lobe}})),
        .moments = LIMN_TRY(load_fullscreen(device, "distance_moments.frag")),
        .sampler = gpu::Sampler(
            "scattered", {.minify = GL_LINEAR_MIPMAP_LINEAR, .wrap = GL_CLAMP_TO_EDGE})};
}

bool SubsurfaceEffect::is_used(const FrameData& frame) {
    return frame.materials->diffuses();
}

bool SubsurfaceEffect::prepare(const FrameData&, ViewData& view) {
    view.spreads = view.data.get<LightingMethod>().method == LightMethod::Clustered;
    view.lighting.variant.add_if(view.spreads, "SCATTERED");
    return view.spreads;
}

void SubsurfaceEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    const TextureId distances = create_target(
        graph, "scattered.distances", GL_RG32F, view.size(), graph.spec(view.scattered).levels);
    add_fullscreen_pass(
        graph, "scattered.distances", {sampled(view.gbuffer.depth, kDepthUnit)},
        {discarded(distances)}, moments,
        [&view](PassContext& context, const gpu::Program&) { bind_view(context, view); });
    graph.add_pass(
        "scattered.levels", {}, {image(view.scattered), image(distances)},
        [&view, distances](PassContext& context) {
            glGenerateTextureMipmap(context.texture(view.scattered).id());
            glGenerateTextureMipmap(context.texture(distances).id());
        });
    gpu::PipelineState state = kWhereLobe;
    state.blend = gpu::kBlendAdd;
    add_fullscreen_pass(
        graph, "subsurface",
        {sampled(view.scattered, kScatteredUnit, &sampler),
         sampled(distances, kDistancesUnit, &sampler), sampled(view.gbuffer.surface, kGbufferUnit),
         sampled(view.gbuffer.material, kGbufferMaterialUnit),
         sampled(view.gbuffer.depth, kDepthUnit),
         depth_tested(view.data.get<ShadingLobes>().depth)},
        {view.radiance}, program, state,
        [&view, &materials = *frame.materials](PassContext& context, const gpu::Program&) {
            bind_view(context, view);
            materials.records().bind(context.device(), kMaterialsUnit);
            const PixelBounds& bounds = view.data.get<LobeBounds>()[kLobe];
            const IVec2 size = glm::max(bounds.high - bounds.low, IVec2(0));
            context.device().set_scissor(bounds.low.x, bounds.low.y, size.x, size.y);
        });
}

}  // namespace limn
