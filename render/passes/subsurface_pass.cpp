#include "render/passes/subsurface_pass.h"

#include "ecs/components/surface.h"
#include "render/fullscreen.h"
#include "render/gpu/device.h"
#include "render/lighting.h"
#include "render/material_pool.h"
#include "render/render_items.h"
#include "render/shading_models.h"
#include "render/view_block.h"

#include <glm/common.hpp>

namespace limn {
namespace {

constexpr unsigned kScatteredUnit = 0;
constexpr unsigned kDistancesUnit = 1;

/// Pixels low .. high - 1 of a view, from below, beyond which no light spreads under surfaces.
struct ScatteringBounds {
    IVec2 low;
    IVec2 high;
};

/// The same of a box in the world; all of the view if the box reaches behind the camera.
ScatteringBounds pixels_of(const RenderView& view, const Bounds& box) {
    Vec2 low(INFINITY);
    Vec2 high(-INFINITY);
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p = {
            (corner & 1) != 0 ? box.max.x : box.min.x, (corner & 2) != 0 ? box.max.y : box.min.y,
            (corner & 4) != 0 ? box.max.z : box.min.z};
        const Vec4 clip = view.clip_from_world * Vec4(p, 1);
        if (!(clip.w > 1e-6f)) {
            return {{0, 0}, {view.width, view.height}};
        }
        low = glm::min(low, Vec2(clip) / clip.w);
        high = glm::max(high, Vec2(clip) / clip.w);
    }
    const Vec2 size = {view.width, view.height};
    const auto pixel = [&](const Vec2& ndc) {
        return glm::clamp((0.5f * ndc + 0.5f) * size, Vec2(0), size);
    };
    return {IVec2(glm::floor(pixel(low))), IVec2(glm::ceil(pixel(high)))};
}

ScatteringBounds find_bounds(const RenderItems& items, const RenderView& view) {
    const MaterialPool& materials = items.materials();
    ScatteringBounds all = {{view.width, view.height}, {0, 0}};
    for (std::size_t b = 0; b < items.block_count(); ++b) {
        const RenderItemBlock& block = items.block(b);
        for (std::size_t i = 0; i < block.size(); ++i) {
            const std::uint32_t model =
                materials.model_of(materials.record_of(block.surfaces[i].material));
            if (model == stored_number(ShadingModel::Subsurface) && block.is_drawable(i)) {
                const ScatteringBounds pixels = pixels_of(view, block.box(i));
                all = {glm::min(all.low, pixels.low), glm::max(all.high, pixels.high)};
            }
        }
    }
    return all;
}

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

bool SubsurfaceEffect::prepare(const FrameData& frame, ViewData& view) {
    view.spreads = view.data.get<LightingMethod>().method == LightMethod::Clustered;
    view.lighting.variant.add_if(view.spreads, "SCATTERED");
    if (view.spreads) {
        view.data.publish<ScatteringBounds>() = find_bounds(*frame.items, view.camera);
    }
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
            const auto& bounds = view.data.get<ScatteringBounds>();
            const IVec2 size = glm::max(bounds.high - bounds.low, IVec2(0));
            context.device().set_scissor(bounds.low.x, bounds.low.y, size.x, size.y);
        });
}

}  // namespace limn
