#include "render/passes/subsurface_pass.h"

#include "ecs/components/surface.h"
#include "render/fullscreen.h"
#include "render/gpu/device.h"
#include "render/lighting.h"
#include "render/material_pool.h"
#include "render/view_block.h"

namespace limn {
namespace {

constexpr unsigned kScatteredUnit = 0;
constexpr unsigned kDistancesUnit = 1;

}  // namespace

Result<SubsurfaceEffect> SubsurfaceEffect::create(gpu::Device& device, const RenderSettings&) {
    return SubsurfaceEffect{
        .program = LIMN_TRY(load_fullscreen(device, "subsurface.frag", {{"MATERIAL_RECORDS"}})),
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
    constexpr gpu::PipelineState kAdd = {
        .depth = {.test = true, .write = false, .func = GL_LESS},
        .blend = gpu::kBlendAdd,
        .cull = GL_NONE};
    add_fullscreen_pass(
        graph, "subsurface",
        {sampled(view.scattered, kScatteredUnit, &sampler),
         sampled(distances, kDistancesUnit, &sampler), sampled(view.gbuffer.surface, kGbufferUnit),
         sampled(view.gbuffer.material, kGbufferMaterialUnit),
         sampled(depth_tested(view.gbuffer.depth), kDepthUnit)},
        {view.radiance}, program, kAdd,
        [&view, &materials = *frame.materials](PassContext& context, const gpu::Program&) {
            bind_view(context, view);
            materials.records().bind(context.device(), kMaterialsUnit);
        });
}

}  // namespace limn
