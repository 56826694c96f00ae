#include "render/light/subsurface_pass.h"

#include "ecs/components/surface.h"
#include "render/fullscreen.h"
#include "render/gpu/device.h"
#include "render/light/lighting.h"
#include "render/light/lobe_bounds.h"
#include "render/material/material_pool.h"
#include "render/material/shading_models.h"
#include "render/shaders/fullscreen_gpu.h"
#include "render/shaders/gbuffer_gpu.h"
#include "render/shaders/material_gpu.h"
#include "render/shaders/material_subsurface_gpu.h"
#include "render/view_block.h"

#include <glm/common.hpp>

#include <span>

// Techniques: skin.diffusion
// Source of skin.diffusion: Christensen and Burley 2015

namespace limn {
namespace {

constexpr int kSubsurfaceGroup = 8;  ///< side of the work groups [px]
constexpr std::uint32_t kSubsurfaceLobe = lobe_number(ShadingModel::Subsurface);

IVec2 size_of(const PixelBounds& bounds) {
    return glm::max(bounds.high - bounds.low, IVec2(0));
}

/// Definitions of the programs that add the scattered light.
Variant diffusion_variant() {
    Variant variant("MATERIAL_RECORDS");
    variant.add("SHADING_LOBE", static_cast<int>(kSubsurfaceLobe));
    return variant;
}

TextureId
measure_distances(FrameGraph& graph, const SubsurfaceEffect& effect, const ViewData& view) {
    const TextureId distances = create_target(
        graph, "scattered.distances", GL_RG32F, view.size(), graph.spec(view.scattered).levels);
    const Use depth = sampled(view.gbuffer.depth, layout::kDepthUnit);
    if (!effect.in_compute) {
        add_fullscreen_pass(
            graph, "scattered.distances", {depth}, {discarded(distances)}, effect.moments,
            [&view](PassContext& context, const gpu::Program&) { bind_view(context, view); });
        return distances;
    }
    graph.add_pass(
        "scattered.distances", {depth}, {image(distances)},
        [&effect, &view, distances](PassContext& context) {
            context.device().use(*effect.moments);
            bind_view(context, view);
            context.bind_image(layout::kDistanceMomentsImage, distances, GL_WRITE_ONLY);
            context.device().dispatch_over(view.size().x, view.size().y, kSubsurfaceGroup);
        });
    return distances;
}

void draw_within(PassContext& context, const gpu::Program& program, const PixelBounds& bounds) {
    gpu::PipelineState state = kWhereLobe;
    state.blend = gpu::kBlendAdd;
    const IVec2 size = size_of(bounds);
    context.device().use(gpu::Pipeline{&program, state});
    context.device().set_scissor(bounds.low.x, bounds.low.y, size.x, size.y);
    context.device().draw_fullscreen();
}

void compute_within(
    PassContext& context, const gpu::Program& program, const PixelBounds& bounds,
    TextureId radiance) {
    const IVec2 size = size_of(bounds);
    context.device().use(program);
    program.set("low", bounds.low);
    program.set("high", bounds.high);
    context.bind_image(layout::kTargetImage, radiance, GL_READ_WRITE);
    context.device().dispatch_over(size.x, size.y, kSubsurfaceGroup);
}

}  // namespace

Result<SubsurfaceEffect> SubsurfaceEffect::create(gpu::Device& device, const RenderSettings&) {
    const bool in_compute = device.caps().profile == gpu::Profile::Gpu;
    SubsurfaceEffect effect{
        .in_compute = in_compute,
        .programs = in_compute ? ProgramVariants(device, {.compute = "subsurface.comp"})
                               : ProgramVariants::fullscreen(device, "subsurface.frag"),
        .moments = LIMN_TRY(
            in_compute ? device.shaders().load({.compute = "distance_moments.comp"})
                       : load_fullscreen(device, "distance_moments.frag")),
        .levels = LIMN_TRY(create_mip_levels(device)),
        .sampler = gpu::Sampler(
            "scattered", {.minify = GL_LINEAR_MIPMAP_LINEAR, .wrap = GL_CLAMP_TO_EDGE})};
    LIMN_TRY(effect.programs.load(diffusion_variant()));
    return effect;
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
    const PixelBounds& bounds = view.data.get<LobeBounds>()[kSubsurfaceLobe];
    Variant variant = diffusion_variant();
    variant.add_if(in_compute && frame.radiance_format == GL_RGBA32F, "FULL_FLOATS");
    const gpu::Program* const program = programs.get(variant);
    if (program == nullptr || (is_empty(bounds) && !frame.warm_up)) {
        return;
    }
    const TextureId distances = measure_distances(graph, *this, view);
    graph.add_pass(
        "scattered.levels", {}, {image(view.scattered), image(distances)},
        [this, &view, distances](PassContext& context) {
            fill_mip_levels(context.device(), levels, context.texture(view.scattered));
            fill_mip_levels(context.device(), levels, context.texture(distances));
        });
    const TextureId radiance = view.radiance;
    const Use reads[] = {
        sampled(view.scattered, layout::kScatteredUnit, &sampler),
        sampled(distances, layout::kDistancesUnit, &sampler),
        sampled(view.gbuffer.surface, layout::kGbufferUnit),
        sampled(view.gbuffer.material, layout::kGbufferMaterialUnit),
        sampled(view.gbuffer.depth, layout::kDepthUnit),
        in_compute ? Use(radiance) : depth_tested(view.data.get<ShadingLobes>().depth)};
    const Use writes[] = {in_compute ? image(radiance) : Use(radiance)};
    graph.add_pass(
        "subsurface", std::span(reads), std::span(writes),
        [this, program, radiance, &view, &bounds](PassContext& context) {
            bind_view(context, view);
            view.frame->materials->records().bind(context.device(), layout::kMaterialsUnit);
            if (in_compute) {
                compute_within(context, *program, bounds, radiance);
            } else {
                draw_within(context, *program, bounds);
            }
        });
}

}  // namespace limn
