#include "render/water/foam_pattern.h"

#include "ecs/base/math.h"
#include "ecs/base/rng.h"

#include <algorithm>
#include <numeric>

namespace limn {

namespace {

/// One point in each cell of a square lattice that repeats.
class CellPoints {
  public:
    CellPoints(int cells, std::uint64_t seed) : cells_(cells) {
        Random random(seed, 0, name_hash("make_foam_pattern"), 0);
        points_.resize(static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells));
        for (Vec2& point : points_) {
            point.x = random.uniform(0.0f, 1.0f);
            point.y = random.uniform(0.0f, 1.0f);
        }
    }

    /// How much nearer the nearest point is than the second; 0 on the walls between cells. `p` in
    /// cells.
    [[nodiscard]] float depth_in_cell(const Vec2& p) const {
        const IVec2 home = IVec2(glm::floor(p));
        float nearest = 1e9f;
        float second = 1e9f;
        for (int dz = -2; dz <= 2; ++dz) {
            for (int dx = -2; dx <= 2; ++dx) {
                const IVec2 cell = home + IVec2(dx, dz);
                const float away = glm::distance(p, Vec2(cell) + point_of(cell));
                second = std::min(second, std::max(nearest, away));
                nearest = std::min(nearest, away);
            }
        }
        return second - nearest;
    }

  private:
    [[nodiscard]] const Vec2& point_of(const IVec2& cell) const {
        const IVec2 in = (cell % cells_ + cells_) % cells_;
        return points_[static_cast<std::size_t>(in.y * cells_ + in.x)];
    }
    int cells_;
    std::vector<Vec2> points_;
};

}  // namespace

std::vector<std::uint8_t> make_foam_pattern() {
    constexpr int kCells[] = {7, 17, 41};
    constexpr float kWeights[] = {1.0f, 0.6f, 0.35f};
    const CellPoints lattices[] = {{kCells[0], 1}, {kCells[1], 2}, {kCells[2], 3}};
    constexpr auto kTexels = static_cast<std::size_t>(kFoamPatternSide * kFoamPatternSide);
    std::vector<float> depths(kTexels);
    for (std::size_t i = 0; i < kTexels; ++i) {
        const auto x = static_cast<float>(i % kFoamPatternSide) + 0.5f;
        const auto z = static_cast<float>(i / kFoamPatternSide) + 0.5f;
        for (int octave = 0; octave < 3; ++octave) {
            const float scale = static_cast<float>(kCells[octave]) / kFoamPatternSide;
            depths[i] += kWeights[octave] * lattices[octave].depth_in_cell(scale * Vec2(x, z));
        }
    }
    std::vector<std::uint32_t> order(kTexels);
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return depths[a] != depths[b] ? depths[a] > depths[b] : a < b;
    });
    std::vector<std::uint8_t> pattern(kTexels);
    for (std::size_t rank = 0; rank < kTexels; ++rank) {
        pattern[order[rank]] = static_cast<std::uint8_t>(rank * 256 / kTexels);
    }
    return pattern;
}

}  // namespace limn
