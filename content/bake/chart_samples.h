#pragma once

#include "ecs/base/math.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Samples of a texture in the charts of a mesh.

/// A sample's point on the mesh.
struct ChartSample {
    std::int32_t triangle = -1;  ///< -1: in no chart
    Vec3 weights = {0, 0, 0};    ///< barycentric coordinates, sum 1
};

/// Triangles in texture space, ready to be sampled in bands of rows.
class Charts {
  public:
    /// `columns` x `rows` samples, at the centers of as many cells of the unit square.
    Charts(
        std::span<const Vec2> uvs, std::span<const std::uint32_t> indices, int columns, int rows);

    /// Replaces `samples` by the rows first .. first + count - 1. Of triangles that overlap, the
    /// first counts. Returns how many samples have several that overlap.
    std::size_t sample(int first, int count, std::vector<ChartSample>& samples) const;

    [[nodiscard]] std::size_t degenerate() const { return degenerate_; }
    [[nodiscard]] std::size_t outside() const { return outside_; }
    [[nodiscard]] bool empty() const { return triangles_.empty(); }

  private:
    struct Triangle {
        glm::dvec2 p[3];  ///< in samples
        std::int32_t index = 0;
        int low_row = 0;
        int high_row = 0;  ///< last
    };

    static constexpr int kBinRows = 32;

    std::vector<Triangle> triangles_;
    std::vector<std::vector<std::uint32_t>> bins_;  ///< triangles at each kBinRows rows
    int columns_ = 0;
    std::size_t degenerate_ = 0;
    std::size_t outside_ = 0;
};

}  // namespace limn
