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
    ClusterLights& culled = m.clusters;
    cull_lights(view, lights, culled);
    ClusterReadbackLists lists = {
        culled.shape, std::vector<layout::uvec2>(culled.shape.cells()), {}, culled.capacity};
    m.view.block = m.ring.push_value(make_view_block(view, culled.shape, lights, false));
    culled.light_records.upload(m.ring, culled.lights);
    culled.box_records.upload(m.ring, culled.boxes);
    const ClusterLists made = build_clusters(m.graph, m.pass, culled, m.view);
    if (made.cells.valid()) {
        lists.indices.resize(culled.capacity);
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
