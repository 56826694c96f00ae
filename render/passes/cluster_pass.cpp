#include "render/passes/cluster_pass.h"

#include "render/gpu/shader_library.h"

#include <bit>

namespace limn {
namespace {

constexpr unsigned kMasksBinding = 0;
constexpr unsigned kCellsBinding = 1;
constexpr unsigned kIndicesBinding = 2;
constexpr unsigned kClusterLightsUnit = 0;
constexpr unsigned kBoxesUnit = 1;
constexpr unsigned kBlocksGroup = 32;  ///< local size of cluster_blocks.comp

unsigned divide_up(std::size_t count, std::size_t by) {
    return static_cast<unsigned>((count + by - 1) / by);
}

unsigned block_count(const ClusterShape& shape) {
    return divide_up(shape.columns, layout::kBlockColumns)
           * divide_up(shape.rows, layout::kBlockRows)
           * divide_up(shape.slices, layout::kBlockSlices);
}

/// Sizes change from frame to frame; powers of two let the pool find the buffer again.
std::size_t rounded(std::size_t bytes) {
    return std::bit_ceil(std::max<std::size_t>(bytes, 1024));
}

}  // namespace

Result<ClusterPass> create_cluster_pass(gpu::Device& device) {
    ClusterPass pass;
    const auto load = [&](const gpu::Program*& program, const gpu::ProgramDesc& desc) -> Status {
        const Result<const gpu::Program*> made = device.shaders().load(desc);
        if (!made) {
            return made.error();
        }
        program = *made;
        return Done{};
    };
    for (const Status& loaded :
         {load(pass.blocks, {.compute = "cluster_blocks.comp"}),
          load(pass.count, {.compute = "cluster_lists.comp"}),
          load(pass.scan, {.compute = "cluster_scan.comp"}),
          load(pass.fill, {.compute = "cluster_lists.comp", .defines = {{"FILL"}}})}) {
        if (!loaded) {
            return loaded.error();
        }
    }
    return pass;
}

ClusterLists build_clusters(FrameGraph& graph, ClusterPass& pass, const FrameScene& scene) {
    const ClusterLights& clusters = scene.clusters;
    ClusterLists lists;
    if (clusters.lights.empty()) {
        return lists;
    }
    const auto lights = static_cast<unsigned>(clusters.lights.size());
    const unsigned words = divide_up(lights, 32);
    const unsigned blocks = block_count(clusters.shape);
    const auto cells = static_cast<unsigned>(clusters.shape.cells());
    const BufferId masks = graph.create_buffer(
        {.name = "cluster masks", .bytes = rounded(std::size_t{4} * blocks * words)});
    lists.cells =
        graph.create_buffer({.name = "light cells", .bytes = rounded(std::size_t{8} * cells)});
    lists.indices = graph.create_buffer(
        {.name = "light indices", .bytes = rounded(std::size_t{4} * clusters.capacity)});

    graph.add_pass(
        "clusters.blocks", {}, {masks},
        [&pass, &scene, masks, lights, blocks, words](PassContext& context) {
            context.device().use(*pass.blocks);
            bind_view(context.device(), scene);
            pass.blocks->set("light_count", lights);
            pass.boxes.bind(context.device(), kBoxesUnit);
            context.bind_storage(kMasksBinding, masks);
            context.device().dispatch(divide_up(blocks, kBlocksGroup), words);
        });
    graph.add_pass(
        "clusters.count", {masks}, {lists.cells},
        [&pass, &scene, masks, lists, lights, blocks](PassContext& context) {
            context.device().use(*pass.count);
            bind_view(context.device(), scene);
            pass.count->set("light_count", lights);
            pass.lights.bind(context.device(), kClusterLightsUnit);
            pass.boxes.bind(context.device(), kBoxesUnit);
            context.bind_storage(kMasksBinding, masks);
            context.bind_storage(kCellsBinding, lists.cells);
            context.device().dispatch(blocks);
        });
    graph.add_pass("clusters.scan", {}, {lists.cells}, [&pass, lists, cells](PassContext& context) {
        context.device().use(*pass.scan);
        pass.scan->set("cell_count", cells);
        context.bind_storage(kCellsBinding, lists.cells);
        context.device().dispatch(1);
    });
    graph.add_pass(
        "clusters.fill", {masks, lists.cells}, {lists.indices},
        [&pass, &scene, masks, lists, lights, blocks](PassContext& context) {
            context.device().use(*pass.fill);
            bind_view(context.device(), scene);
            pass.fill->set("light_count", lights);
            pass.lights.bind(context.device(), kClusterLightsUnit);
            pass.boxes.bind(context.device(), kBoxesUnit);
            context.bind_storage(kMasksBinding, masks);
            context.bind_storage(kCellsBinding, lists.cells);
            context.bind_storage(kIndicesBinding, lists.indices);
            context.device().dispatch(blocks);
            pass.cells.set(context.buffer(lists.cells));
            pass.indices.set(context.buffer(lists.indices));
        });
    return lists;
}

}  // namespace limn
