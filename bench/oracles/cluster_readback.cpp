#include "bench/oracles/cluster_readback.h"

#include "render/gpu/device.h"
#include "render/view_block.h"

namespace limn::oracle {

struct ClusterReadback::Machine {
    Machine(gpu::Device& device, ClusterPass made)
        : graph(device), ring(device.caps(), "cluster readback", std::size_t{1} << 20),
          pass(std::move(made)) {}

    FrameGraph graph;
    gpu::RingBuffer ring;
    ClusterPass pass;
    ClusterLights clusters;
    ViewData view;
};

void ClusterReadback::Deleter::operator()(Machine* machine) const {
    delete machine;
}

std::size_t ClusterReadbackLists::total() const {
    std::size_t sum = 0;
    for (const layout::uvec2& cell : cells) {
        sum += cell.y;
    }
    return sum;
}

ClusterReadback::ClusterReadback(std::unique_ptr<Machine, Deleter> machine)
    : machine_(std::move(machine)) {}

Result<ClusterReadback> ClusterReadback::create(gpu::Device& device) {
    return ClusterReadback(std::unique_ptr<Machine, Deleter>(
        new Machine(device, LIMN_TRY(create_cluster_pass(device)))));
}

ClusterReadbackLists ClusterReadback::run(const RenderView& view, const LightList& lights) {
    Machine& m = *machine_;
    m.graph.begin_frame();
    m.ring.begin_frame();
    ClusterLights& placed = m.clusters;
    place_lights(view, lights, placed);
    ClusterReadbackLists lists = {
        placed.shape, std::vector<layout::uvec2>(placed.shape.cells()), {}, placed.capacity};
    m.view.block = m.ring.push_value(make_view_block(view, placed.shape, lights, false));
    placed.light_records.upload(m.ring, placed.lights);
    placed.box_records.upload(m.ring, placed.boxes);
    const ClusterLists made = build_clusters(m.graph, m.pass, placed, m.view);
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
