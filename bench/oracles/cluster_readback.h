#pragma once

#include "render/gpu/ring_buffer.h"
#include "render/graph/frame_graph.h"
#include "render/light/cluster_pass.h"

#include <memory>
#include <span>
#include <vector>

namespace limn::oracle {

/// The GPU's light cluster lists; cells are indexed by cell_of().
struct ClusterReadbackLists {
    ClusterShape shape;
    std::vector<layout::uvec2> cells;  ///< begin and length
    std::vector<layout::uint> indices;
    std::size_t capacity = 0;

    [[nodiscard]] std::span<const layout::uint> of(int cell) const {
        return std::span(indices).subspan(cells[cell].x, cells[cell].y);
    }
    [[nodiscard]] std::size_t total() const;  ///< total length of all lists
};

/// Runs only the cluster passes and reads back their lists, for comparison with the oracle.
class ClusterReadback {
  public:
    [[nodiscard]] static Result<ClusterReadback> create(gpu::Device& device);
    [[nodiscard]] ClusterReadbackLists run(const RenderView& view, const LightList& lights);

  private:
    struct Machine;
    struct Deleter {
        void operator()(Machine* machine) const;
    };
    explicit ClusterReadback(std::unique_ptr<Machine, Deleter> machine);
    std::unique_ptr<Machine, Deleter> machine_;
};

}  // namespace limn::oracle
