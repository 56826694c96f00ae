#include "render/light/cluster_pass.h"

#include "ecs/base/log.h"
#include "ecs/components/shading_comparison.h"
#include "ecs/world.h"
#include "render/geometry/instance_list.h"
#include "render/gpu/branch_cost.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/material/shading_models.h"
#include "render/render_frame.h"
#include "render/shaders/cluster_gpu.h"
#include "render/shaders/light_gpu.h"
#include "render/view_block.h"

#include <algorithm>
#include <bit>
#include <cstdint>

// Techniques: fakephong.blinn-axis, light.clustered

namespace limn {
namespace {

constexpr unsigned kBlocksGroup = 32;  ///< local size of cluster_blocks.comp

unsigned divide_up(std::size_t count, std::size_t by) {
    return static_cast<unsigned>((count + by - 1) / by);
}

unsigned block_count(const ClusterShape& shape) {
    return divide_up(shape.columns, layout::kBlockColumns)
           * divide_up(shape.rows, layout::kBlockRows)
           * divide_up(shape.slices, layout::kBlockSlices);
}

/// Sizes vary from frame to frame; rounding to powers of two lets the pool reuse the buffer.
std::size_t rounded(std::size_t bytes) {
    return std::bit_ceil(std::max<std::size_t>(bytes, 1024));
}

BufferId create_cells(FrameGraph& graph, const ClusterShape& shape) {
    const auto cells = static_cast<std::size_t>(shape.cells());
    return graph.create_buffer({.name = "light cells", .bytes = rounded(8 * cells)});
}

BufferId create_indices(FrameGraph& graph, std::size_t capacity) {
    return graph.create_buffer({.name = "light indices", .bytes = rounded(4 * capacity)});
}

/// Whether the loop over directional lights is unrolled. One pass reads a shadow and evaluates a
/// lobe, some 120 cycles.
bool unrolls(LightLoops loops, int count) {
    constexpr double kLightCycles = 120;
    return loops == LightLoops::Unrolled
           || (loops == LightLoops::Auto && gpu::should_unroll(count, kLightCycles));
}

/// The empty lists of a view without lights.
ClusterLists clear_clusters(FrameGraph& graph, ClusterPass& pass, const ClusterShape& shape) {
    const ClusterLists lists = {
        create_cells(graph, shape), create_indices(graph, 0), &pass.cells, &pass.indices};
    graph.add_pass(
        "clusters.none", {}, {lists.cells, lists.indices}, [&pass, lists](PassContext& context) {
            context.buffer(lists.cells).clear(0);
            pass.cells.set(context.buffer(lists.cells));
            pass.indices.set(context.buffer(lists.indices));
        });
    return lists;
}

}  // namespace

Result<ClusterPass> create_cluster_pass(gpu::Device& device) {
    ClusterPass pass;
    gpu::ShaderLibrary& shaders = device.shaders();
    pass.blocks = LIMN_TRY(shaders.load({.compute = "cluster_blocks.comp"}));
    pass.count = LIMN_TRY(shaders.load({.compute = "cluster_lists.comp"}));
    pass.scan = LIMN_TRY(shaders.load({.compute = "cluster_scan.comp"}));
    pass.fill = LIMN_TRY(shaders.load({.compute = "cluster_lists.comp", .defines = {{"FILL"}}}));
    return pass;
}

ClusterLists build_clusters(
    FrameGraph& graph, ClusterPass& pass, const ClusterLights& clusters, const ViewData& view) {
    ClusterLists lists;
    if (clusters.lights.empty()) {
        return lists;
    }
    lists.cell_texture = &pass.cells;
    lists.index_texture = &pass.indices;
    const unsigned words = divide_up(clusters.lights.size(), 32);
    const unsigned blocks = block_count(clusters.shape);
    const auto cells = static_cast<unsigned>(clusters.shape.cells());
    const BufferId masks = graph.create_buffer(
        {.name = "cluster masks", .bytes = rounded(std::size_t{4} * blocks * words)});
    lists.cells = create_cells(graph, clusters.shape);
    lists.indices = create_indices(graph, clusters.capacity);

    graph.add_pass(
        "clusters.blocks", {}, {masks},
        [&pass, &clusters, &view, masks, blocks, words](PassContext& context) {
            context.device().use(*pass.blocks);
            bind_view(context, view);
            clusters.light_records.bind(context.device(), layout::kClusterLightsUnit);
            clusters.box_records.bind(context.device(), layout::kClusterBoxesUnit);
            context.bind_storage(layout::kClusterMasksBinding, masks);
            context.device().dispatch(divide_up(blocks, kBlocksGroup), words);
        });
    graph.add_pass(
        "clusters.count", {masks}, {lists.cells},
        [&pass, &clusters, &view, masks, lists, blocks](PassContext& context) {
            context.device().use(*pass.count);
            bind_view(context, view);
            clusters.light_records.bind(context.device(), layout::kClusterLightsUnit);
            clusters.box_records.bind(context.device(), layout::kClusterBoxesUnit);
            context.bind_storage(layout::kClusterMasksBinding, masks);
            context.bind_storage(layout::kClusterCellsBinding, lists.cells);
            context.device().dispatch(blocks);
        });
    graph.add_pass("clusters.scan", {}, {lists.cells}, [&pass, lists, cells](PassContext& context) {
        context.device().use(*pass.scan);
        pass.scan->set("cell_count", cells);
        context.bind_storage(layout::kClusterCellsBinding, lists.cells);
        context.device().dispatch(1);
    });
    graph.add_pass(
        "clusters.fill", {masks, lists.cells}, {lists.indices},
        [&pass, &clusters, &view, masks, lists, blocks](PassContext& context) {
            context.device().use(*pass.fill);
            bind_view(context, view);
            clusters.light_records.bind(context.device(), layout::kClusterLightsUnit);
            clusters.box_records.bind(context.device(), layout::kClusterBoxesUnit);
            context.bind_storage(layout::kClusterMasksBinding, masks);
            context.bind_storage(layout::kClusterCellsBinding, lists.cells);
            context.bind_storage(layout::kClusterIndicesBinding, lists.indices);
            context.device().dispatch(blocks);
            pass.cells.set(context.buffer(lists.cells));
            pass.indices.set(context.buffer(lists.indices));
        });
    return lists;
}

Result<LightListEffect> LightListEffect::create(gpu::Device& device, const RenderSettings&) {
    return LightListEffect{LIMN_TRY(create_cluster_pass(device))};
}

void LightListEffect::collect(FrameData& frame) {
    collect_lights(
        *frame.world, frame.camera.alpha, frame.data.publish<LightList>(), frame.all_lights);
}

bool LightListEffect::prepare(const FrameData& frame, ViewData& view) {
    const auto* found = frame.world->find_resource<Rendering>();
    const Rendering rendering = found != nullptr && view.is(kMainViews) ? *found : Rendering{};
    auto& method = view.data.publish<LightingMethod>();
    method.shading = rendering.shading;
    const auto* comparison = frame.world->find_resource<ShadingComparison>();
    method.compared.reset();
    if (comparison != nullptr && view.is(kMainViews)) {
        method.compared = comparison->right;
    }
    method.highlights = rendering.highlight_layout;
    method.worst_blinn_axis = rendering.blinn_axis == BlinnAxis::WorstCase;
    method.blinn_diffuse = rendering.blinn_diffuse;
    method.screen_interpolation = rendering.screen_interpolation;
    method.hardware = rendering.hardware;
    method.method = method.shading == ShadingRate::Pixel && !method.compared
                        ? rendering.lights
                        : LightMethod::ObjectMajor;
    method.infinite_viewer = rendering.infinite_viewer;

    auto& lights = view.data.publish<LightList>();
    lights = frame.data.get<LightList>();
    auto& culled = view.data.publish<ClusterLights>();
    culled.max_entries = std::min(kMaxListEntries, BufferTexture::max_texel_count());
    cull_lights(view.camera, lights, culled);
    culled.light_records.upload(*frame.ring, culled.lights);
    culled.box_records.upload(*frame.ring, culled.boxes);
    if (culled.dropped > 0 && !dropped_reported) {
        log_warn(
            "lights: {} of {} cover so much of the image that the cluster lists have no room for "
            "them (ClusterLights::max_entries); they are not shown",
            culled.dropped, lights.ranges.size());
        dropped_reported = true;
    }
    view.block = frame.ring->push_value(
        make_view_block(view.camera, culled.shape, lights, method.infinite_viewer));

    Variant& variant = view.lighting.variant;
    variant.add_if(lights.directional > 0, "DIRECTIONAL_LIGHTS");
    if (lights.directional > 0 && unrolls(rendering.light_loops, lights.directional)) {
        variant.add("DIRECTIONAL_COUNT", lights.directional);
    }
    variant.add_if(lights.spots > 0, "SPOT_LIGHTS");
    variant.add_if(lights.spot_angles, "SPOT_ANGLES");
    variant.add_if(lights.linear_fade, "LINEAR_FADE");
    variant.add_if(!lights.ranges.empty(), "LOCAL_LIGHTS");
    add_shading_models(variant, frame.materials->shading_models());
    add_layers(variant, frame.materials->layers());
    variant.add_if(frame.materials->key_shadows(), "KEY_SHADOWS");
    variant.add_if(frame.materials->bump_shadows(), "SMOOTH_NORMALS");
    return true;
}

void LightListEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    const bool by_clusters = view.data.get<LightingMethod>().method == LightMethod::Clustered
                             || !view.data.get<InstanceList>().blended.empty();
    if (!by_clusters || view.data.get<LightList>().ranges.empty()) {
        return;
    }
    const auto& culled = view.data.get<ClusterLights>();
    const ClusterLists lists = culled.lights.empty()
                                   ? clear_clusters(graph, clusters, culled.shape)
                                   : build_clusters(graph, clusters, culled, view);
    auto& published = view.data.publish<ClusterLists>();
    published = lists;
    view.lighting.reads.insert(view.lighting.reads.end(), {lists.cells, lists.indices});
    view.lighting.add_binding<[](PassContext& context, const ClusterLists& found) {
        found.index_texture->bind(context.device(), layout::kLightIndicesUnit);
        found.cell_texture->bind(context.device(), layout::kLightCellsUnit);
    }>(published);
}

void LightListEffect::report(const FrameData&, const ViewData& view, FrameOutput& out) {
    if (const auto* lights = view.data.find<LightList>()) {
        out.statistics.lights = static_cast<int>(lights->records.size());
    }
}

}  // namespace limn
