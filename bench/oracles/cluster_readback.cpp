#include "bench/oracles/cluster_readback.h"

#include "render/gpu/device.h"

#include <algorithm>
#include <cstring>

namespace limn::oracle {

struct ClusterReadback::Machine {
    Machine(gpu::Device& device, ClusterPass made)
        : graph(device), ring(device.caps(), "cluster readback", std::size_t{1} << 20),
          pass(std::move(made)) {}

    gpu::RingSlice push(std::span<const std::byte> bytes) {
        const gpu::RingSlice slice =
            ring.allocate(std::max<std::size_t>(bytes.size(), 16), BufferTexture::alignment());
        if (!bytes.empty()) {
            std::memcpy(slice.data, bytes.data(), bytes.size());
        }
        return slice;
    }

    FrameGraph graph;
    gpu::RingBuffer ring;
    ClusterPass pass;
    FrameScene scene;
};

void ClusterReadback::Deleter::operator()(Machine* machine) const {
    delete machine;
}

std::size_t ReadClusters::total() const {
    std::size_t sum = 0;
    for (const layout::uvec2& cell : cells) {
        sum += cell.y;
    }
    return sum;
}

ClusterReadback::ClusterReadback(std::unique_ptr<Machine, Deleter> machine)
    : machine_(std::move(machine)) {}

Result<ClusterReadback> ClusterReadback::create(gpu::Device& device) {
    Result<ClusterPass> pass = create_cluster_pass(device);
    if (!pass) {
        return pass.error();
    }
    return ClusterReadback(
        std::unique_ptr<Machine, Deleter>(new Machine(device, *std::move(pass))));
}

ReadClusters ClusterReadback::run(const RenderView& view, const LightList& lights) {
    Machine& m = *machine_;
    m.graph.begin_frame();
    m.ring.begin_frame();
    place_lights(view, lights, m.scene.clusters);
    const ClusterLights& placed = m.scene.clusters;
    ReadClusters lists = {
        placed.shape, std::vector<layout::uvec2>(placed.shape.cells()), {}, placed.capacity};
    m.scene.view_block = m.ring.push_value(make_view_block(view, placed.shape, lights));
    m.pass.lights.set(m.push(std::as_bytes(std::span(placed.lights))));
    m.pass.boxes.set(m.push(std::as_bytes(std::span(placed.boxes))));
    const ClusterLists made = build_clusters(m.graph, m.pass, m.scene);
    if (made.cells.valid()) {
        lists.indices.resize(placed.capacity);
        m.graph.add_pass(
            "read", {made.cells, made.indices}, {}, [&lists, made](PassContext& context) {
                context.buffer(made.cells).read(0, std::as_writable_bytes(std::span(lists.cells)));
                context.buffer(made.indices)
                    .read(0, std::as_writable_bytes(std::span(lists.indices)));
            });
        m.graph.always_run();
    }
    m.graph.execute();
    m.ring.end_frame();
    return lists;
}

}  // namespace limn::oracle
