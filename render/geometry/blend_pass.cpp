#include "render/geometry/blend_pass.h"

#include "render/geometry/instance_list.h"
#include "render/geometry/surface_draws.h"
#include "render/light/lighting.h"
#include "render/shaders/material_clear_gpu.h"
#include "render/view_block.h"

#include <algorithm>

namespace limn {
namespace {

bool has_any(std::span<const DrawRun> runs, SurfaceFeature feature) {
    return std::any_of(runs.begin(), runs.end(), [feature](const DrawRun& run) {
        return run.features.has(feature);
    });
}

/// A copy of the image so far, with mip levels.
TextureId copy_behind_surfaces(FrameGraph& graph, const MipLevels& levels, TextureId radiance) {
    TextureSpec spec = graph.spec(radiance);
    spec.name = "behind clear media";
    spec.levels = gpu::full_level_count(spec.width, spec.height);
    const TextureId behind = graph.create(spec);
    graph.add_pass(
        "behind clear media", {radiance}, {image(behind)},
        [&levels, behind, radiance](PassContext& context) {
            const gpu::Texture& copy = context.texture(behind);
            context.texture(radiance).copy_to(copy);
            fill_mip_levels(context.device(), levels, copy);
        });
    return behind;
}

/// A copy of the depth of opaque surfaces.
TextureId copy_depth(FrameGraph& graph, TextureId depth) {
    TextureSpec spec = graph.spec(depth);
    spec.name = "depth behind clear media";
    const TextureId copy = graph.create(spec);
    graph.add_pass(
        "depth behind clear media", {depth}, {image(copy)}, [copy, depth](PassContext& context) {
            context.texture(depth).copy_to(context.texture(copy));
        });
    return copy;
}

/// Draws a run; if it is double-sided, back faces first.
void draw_blended(
    PassContext& context, const ViewData& view, const DrawRun& run, ProgramVariants& programs,
    SurfaceDraw draw) {
    if (!run.features.has(kDoubleSided)) {
        draw_runs(context, view, {&run, 1}, programs, draw);
        return;
    }
    draw.features |= kDoubleSided;
    DrawRun side = run;
    side.features.bits &= ~std::uint32_t{kDoubleSided};
    for (int i = 0; i < 2; ++i) {
        side.mirrored = !side.mirrored;
        draw_runs(context, view, {&side, 1}, programs, draw);
    }
}

}  // namespace

Result<BlendEffect> BlendEffect::create(gpu::Device& device, const RenderSettings&) {
    BlendEffect effect{
        .programs = ProgramVariants::of_meshes(device, "blend.frag"),
        .depths = ProgramVariants::of_meshes(device, "depth_first.frag"),
        .levels = LIMN_TRY(create_mip_levels(device))};
    LIMN_TRY(effect.programs.load());
    return effect;
}

void BlendEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    if (view.data.get<InstanceList>().blended.empty()) {
        return;
    }
    const std::vector<DrawRun>& runs = view.data.get<InstanceList>().blended;
    const bool clipped = is_clipped(view);
    const bool nearest_only = !clipped && has_any(runs, kRefraction);
    TextureId behind_depth = view.gbuffer.depth;
    if (nearest_only) {
        behind_depth = copy_depth(graph, view.gbuffer.depth);
        const std::vector<Use> meshes = mesh_reads(graph, *view.frame);
        const Use depth[] = {view.gbuffer.depth};
        graph.add_pass(
            "depth of clear media", std::span<const Use>(meshes), depth,
            [this, &view, &runs](PassContext& context) {
                for (const DrawRun& run : runs) {
                    if (run.features.has(kRefraction)) {
                        draw_depths(context, view, {&run, 1}, depths);
                    }
                }
            });
    }
    std::vector<Use> reads =
        mesh_reads(graph, *view.frame, lighting_reads(view, {depth_tested(view.gbuffer.depth)}));
    if (has_any(runs, kTransmission)) {
        reads.push_back(
            sampled(copy_behind_surfaces(graph, levels, view.radiance), layout::kBehindClearUnit));
        reads.push_back(sampled(behind_depth, layout::kBehindClearDepthUnit));
    }
    const Use writes[] = {view.radiance};
    graph.add_pass(
        "blended", std::span<const Use>(reads), writes,
        [this, &view, &runs, clipped, nearest_only](PassContext& context) {
            Variant variant = view.lighting.variant;
            variant.add_if(clipped, "CLIPPED");
            bind_lighting(context, view);
            for (const DrawRun& run : runs) {
                const bool is_nearest = nearest_only && run.features.has(kRefraction);
                const SurfaceDraw draw = {
                    .variant = &variant,
                    .state = {
                        .depth =
                            {.write = false,
                             .func = static_cast<GLenum>(is_nearest ? GL_EQUAL : GL_GREATER)},
                        .blend = gpu::kBlendPremultiplied,
                        .clip = clipped}};
                draw_blended(context, view, run, programs, draw);
            }
        });
}

}  // namespace limn
