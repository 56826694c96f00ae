#pragma once

#include "render/gpu/ring_buffer.h"
#include "render/graph/frame_graph.h"
#include "render/passes/cluster_pass.h"

#include <memory>
#include <span>
#include <vector>

namespace limn::oracle {

/// The lists of the light clusters as the GPU made them; cells as cell_of() numbers them.
struct ReadClusters {
    ClusterShape shape;
    std::vector<layout::uvec2> cells;  ///< begin and length
    std::vector<layout::uint> indices;
    std::size_t capacity = 0;

    [[nodiscard]] std::span<const layout::uint> of(int cell) const {
        return std::span(indices).subspan(cells[cell].x, cells[cell].y);
    }
    [[nodiscard]] std::size_t total() const;  ///< length of all lists
};

/// Runs the cluster passes alone and reads back what they made, to be held against the oracle.
class ClusterReadback {
  public:
    [[nodiscard]] static Result<ClusterReadback> create(gpu::Device& device);
    [[nodiscard]] ReadClusters run(const RenderView& view, const LightList& lights);

  private:
    struct Machine;
    struct Deleter {
        void operator()(Machine* machine) const;
    };
    explicit ClusterReadback(std::unique_ptr<Machine, Deleter> machine);
    std::unique_ptr<Machine, Deleter> machine_;
};

}  // namespace limn::oracle
