#include "render/light/forward_pass.h"

#include "render/geometry/surface_draws.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/light/bump_strategy.h"
#include "render/light/highlight_layers.h"
#include "render/light/light_list.h"
#include "render/light/lighting.h"
#include "render/light/shading_rates.h"
#include "render/shaders/highlight_gpu.h"
#include "render/shaders/light_gpu.h"
#include "render/view_block.h"

#include <algorithm>
#include <bit>
#include <utility>

// Techniques: engine.depth-first, engine.light-loops, fakephong.pipeline, fakephong.texmap,
//     light.structure-light-major, light.structure-object-major, shade.z-prepass

namespace limn {
namespace {

constexpr int kStencilRefs = 255;  ///< distinct stencil references

/// Shades the nearest surface, and only one of several at equal depth, once per draw; the stencil
/// must be cleared after every kStencilRefs draws.
gpu::PipelineState nearest_once(int draw) {
    const gpu::StencilFace other_turns = {.func = GL_NOTEQUAL, .pass = GL_REPLACE};
    return {
        .depth = {.write = false, .func = GL_EQUAL},
        .stencil = {
            .test = true,
            .reference = static_cast<std::uint8_t>(1 + draw % kStencilRefs),
            .front = other_turns,
            .back = other_turns}};
}

void clear_stencil(gpu::Device& device, const gpu::Program& nothing) {
    gpu::PipelineState zero = gpu::kFullscreenState;
    zero.stencil = {.test = true, .front = {.pass = GL_ZERO}, .back = {.pass = GL_ZERO}};
    zero.color_mask = 0;
    device.use(gpu::Pipeline{&nothing, zero});
    device.draw_fullscreen();
}

/// What the shaders of a ShadingRate are compiled with.
void add_definitions(
    Variant& variant, const ShadingRateRow& row, const LightingMethod& method, int lights) {
    const bool diffuse = method.blinn_diffuse && row.reads_diffuse;
    variant.add_if(diffuse, "BLINN_DIFFUSE");
    if (row.single_lights > 0) {
        const auto kept = static_cast<unsigned>(
            std::clamp(lights, 1, diffuse ? kMaxDiffuseLights : row.single_lights));
        variant.add("SINGLE_LIGHTS", static_cast<int>(std::bit_ceil(kept)));
    }
    if (row.map == HighlightMap::Environment) {
        variant.add("ENVIRONMENT_LAYOUT", static_cast<int>(method.highlights));
    }
    variant.add_if(method.worst_blinn_axis && row.map == HighlightMap::Blinn, "WORST_AXIS");
    variant.add_if(method.screen_interpolation, "SCREEN_LINEAR");
    const HardwareDefects& defects = method.hardware;
    const bool quadratic = row.rate == ShadingRate::HwQuadratic;
    const bool blinn = row.rate == ShadingRate::HwBlinn;
    variant.add_if(defects.first_light && (quadratic || blinn), "HW_FIRST_LIGHT");
    variant.add_if(defects.color_register && quadratic, "HW_REGISTER");
    variant.add_if(defects.midpoint_normals && quadratic, "HW_MIDPOINTS");
    variant.add_if(defects.axis_length && blinn, "HW_AXIS");
    variant.add_if(defects.world_up && blinn, "HW_UP");
    variant.add_if(defects.lit_backs && blinn, "HW_BACKS");
}

ProgramVariants
meshes(gpu::Device& device, const char* vertex, const char* geometry, const char* fragment) {
    return {device, {.vertex = vertex, .geometry = geometry, .fragment = fragment}, true};
}

void draw_object_major(
    PassContext& context, ForwardPass& pass, const ViewData& view, ShadingRate rate,
    std::span<const DrawRun> runs, int draw) {
    const auto& records = view.data.get<LightRecords>();
    bind_lighting(context, view);
    bind_shadow_masks(context, view);
    records.object_indices.bind(context.device(), layout::kLightIndicesUnit);
    records.object_lists.bind(context.device(), layout::kLightCellsUnit);
    Variant variant = view.lighting.variant;
    variant.add("OBJECT_LIGHTS");
    const auto& method = view.data.get<LightingMethod>();
    const ShadingRateRow& row = row_of(rate);
    add_definitions(
        variant, row, method, static_cast<int>(view.data.get<LightList>().records.size()));
    if (row.map != HighlightMap::None) {
        const HighlightMaps::Map& map =
            view.data.get<HighlightMaps>().maps[static_cast<std::size_t>(row.map)];
        context.bind_texture(layout::kHighlightMapsUnit, map.layers);
        map.layer_of_material->bind(context.device(), layout::kHighlightLayersUnit);
    }
    draw_runs(
        context, view, runs, pass.rates[static_cast<std::size_t>(row.rate)],
        {.variant = &variant, .state = nearest_once(draw)});
}

void draw_object_major(
    PassContext& context, ForwardPass& pass, const ViewData& view, ShadingRate rate, int draw) {
    const auto& list = view.data.get<InstanceList>();
    if (rate != ShadingRate::BumpAuto) {
        draw_object_major(context, pass, view, rate, list.opaque, draw);
        return;
    }
    const BumpRuns runs = split_bump_runs(list, *view.frame->meshes, view.data.get<LightList>());
    draw_object_major(context, pass, view, ShadingRate::BumpVertex, runs.vertex, draw);
    draw_object_major(context, pass, view, ShadingRate::BumpAuto, runs.pixel, draw);
}

void add_lights(PassContext& context, ForwardPass& pass, const ViewData& view) {
    const auto& records = view.data.get<LightRecords>();
    bind_lighting(context, view);
    bind_shadow_masks(context, view);
    int draw = 0;  // the first is the draw of ambient light
    const auto next_turn = [&] {
        if (++draw % kStencilRefs == 0) {
            clear_stencil(context.device(), *pass.nothing);
        }
        gpu::PipelineState state = nearest_once(draw);
        state.blend = gpu::kBlendAdd;
        return state;
    };
    Variant directional = view.lighting.variant;
    directional.add("DIRECTIONAL_LIGHT");
    for (int i = 0; i < view.data.get<LightList>().directional; ++i) {
        draw_runs(
            context, view, view.data.get<InstanceList>().opaque, pass.one,
            {.variant = &directional, .state = next_turn(), .light = i});
    }
    const std::span<const LightRun> runs = records.draws.runs;
    for (std::size_t begin = 0, end = 0; begin < runs.size(); begin = end) {
        while (end < runs.size() && runs[end].light == runs[begin].light) {
            ++end;
        }
        draw_light_runs(
            context, view, runs.subspan(begin, end - begin), records.commands, pass.one,
            {.variant = &view.lighting.variant, .state = next_turn()});
    }
}

}  // namespace

Result<ForwardPass> create_forward_pass(gpu::Device& device) {
    ForwardPass pass{
        .base = ProgramVariants::of_meshes(device, "forward_base.frag"),
        .one = ProgramVariants::of_meshes(device, "forward_one.frag"),
        .vertex_depth = ProgramVariants::of_meshes(device, "depth_first.frag"),
        .facet_depth = meshes(device, "sampled.vert", "facet_depth.geom", "depth_first.frag"),
        .nothing = LIMN_TRY(
            device.shaders().load({.vertex = "fullscreen.vert", .fragment = "nothing.frag"}))};
    for (const ShadingRateRow& row : kShadingRateRows) {
        pass.rates.push_back(meshes(device, row.vertex, row.geometry, row.fragment));
    }
    return pass;
}

void draw_forward(FrameGraph& graph, ForwardPass& pass, const ViewData& view, TextureId compared) {
    std::vector<Use> reads = mesh_reads(graph, *view.frame, lighting_reads(view, {}));
    if (const auto* maps = view.data.find<HighlightMaps>()) {
        for (const HighlightMaps::Map& map : maps->maps) {
            if (map.layers.valid()) {
                reads.emplace_back(map.layers);
            }
        }
    }
    const Use first[] = {cleared(view.radiance), view.gbuffer.depth};
    const auto& method = view.data.get<LightingMethod>();
    if (method.method == LightMethod::ObjectMajor) {
        bool by_facets = false;  // the depth was drawn through a geometry shader, as the rate is
        const auto light = [&](const char* name, ShadingRate rate, const Use& into, int draw) {
            const bool facets = *row_of(rate).geometry != '\0';
            if (std::exchange(by_facets, facets) != facets) {
                const Use depth[] = {cleared(view.gbuffer.depth)};
                graph.add_pass(
                    "objects.depth", mesh_reads(graph, *view.frame), depth,
                    [&programs = facets ? pass.facet_depth : pass.vertex_depth,
                     &view](PassContext& context) {
                        bind_view(context, view);
                        draw_depths(context, view, view.data.get<InstanceList>().opaque, programs);
                    });
            }
            const Use writes[] = {into, view.gbuffer.depth};
            graph.add_pass(
                name, std::span(reads), writes, [&pass, &view, rate, draw](PassContext& context) {
                    draw_object_major(context, pass, view, rate, draw);
                });
        };
        light("objects", method.shading, cleared(view.radiance), 0);
        if (method.compared) {
            light("objects, compared", *method.compared, cleared(compared), 1);
            if (view.frame->warm_up) {  // the user can switch methods with keys
                for (const ShadingRateRow& row : kShadingRateRows) {
                    light("objects, any method", row.rate, compared, 1);
                }
            }
        }
        return;
    }
    graph.add_pass("objects.base", std::span(reads), first, [&pass, &view](PassContext& context) {
        bind_lighting(context, view);
        draw_runs(
            context, view, view.data.get<InstanceList>().opaque, pass.base,
            {.variant = &view.lighting.variant, .state = nearest_once(0)});
    });
    const Use writes[] = {view.radiance, view.gbuffer.depth};
    graph.add_pass(
        "objects.lights", std::span(reads), writes,
        [&pass, &view](PassContext& context) { add_lights(context, pass, view); });
}

}  // namespace limn
