#include "render/water/foam_pattern.h"

#include "ecs/base/math.h"
#include "ecs/base/rng.h"

#include <algorithm>
#include <numeric>

namespace limn {

namespace {

/// One random point in each cell of a tiling square lattice.
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

    /// Worley F2 - F1: distance to the second nearest point minus that to the nearest; 0 on the
    /// walls between cells. `p` in cells.
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

/// Equalizes to 0 .. 255 by rank, largest depth first.
std::vector<std::uint8_t> equalize(const std::vector<float>& depths) {
    std::vector<std::uint32_t> order(depths.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return depths[a] != depths[b] ? depths[a] > depths[b] : a < b;
    });
    std::vector<std::uint8_t> even(depths.size());
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
        even[order[rank]] = static_cast<std::uint8_t>((2 * rank + 1) * 128 / order.size());
    }
    return even;
}

/// Downsamples a square by 2 x 2 averaging, in place; empty for a single texel.
void halve(int side, std::vector<float>& texels) {
    const auto from = static_cast<std::size_t>(side);
    const std::size_t to = from / 2;
    for (std::size_t i = 0; i < to * to; ++i) {
        const float* const at = texels.data() + 2 * (i / to) * from + 2 * (i % to);
        texels[i] = 0.25f * (at[0] + at[1] + at[from] + at[from + 1]);
    }
    texels.resize(to * to);
}

}  // namespace

std::vector<std::vector<std::uint8_t>> make_foam_pattern() {
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
    std::vector<std::vector<std::uint8_t>> levels;
    for (int side = kFoamPatternSide; side > 0; side /= 2) {
        levels.push_back(equalize(depths));
        halve(side, depths);
    }
    return levels;
}

}  // namespace limn
