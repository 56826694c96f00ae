#include "content/bake/cone_map.h"

#include "ecs/base/check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <vector>

namespace limn {

namespace {

constexpr float kConeStep = 0.25f;  // along rays, in texels
constexpr int kConeBlock = 8;       // texels along the side of a block

int floor_divide(int a, int b) {
    return a >= 0 ? a / b : -((-a + b - 1) / b);
}

/// Depths with what is needed to skip blocks of them.
class ConeBaker {
  public:
    ConeBaker(const BakedMap& relief, bool repeats)
        : width_(relief.width), height_(relief.height), repeats_(repeats) {
        depths_.reserve(relief.texels.size());
        for (const Vec4& texel : relief.texels) {
            depths_.push_back(std::isnan(texel.w) ? 1.0f : std::clamp(texel.w, 0.0f, 1.0f));
        }
        blocks_x_ = (width_ + kConeBlock - 1) / kConeBlock;
        blocks_y_ = (height_ + kConeBlock - 1) / kConeBlock;
        least_.assign(static_cast<std::size_t>(blocks_x_) * static_cast<std::size_t>(blocks_y_), 1);
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) {
                float& least = least_[block_at(x / kConeBlock, y / kConeBlock)];
                least = std::min(least, depth_at(x, y));
            }
        }
    }

    /// Visits blocks of texels in growing squares around (x, y) until none can matter.
    [[nodiscard]] float ratio(int x, int y, float widest) const {
        const float depth = depth_at(x, y);
        float best = widest;
        const int bx = x / kConeBlock;
        const int by = y / kConeBlock;
        const float texel =
            std::min(1.0f / static_cast<float>(width_), 1.0f / static_cast<float>(height_));
        const int last_ring = std::max(blocks_x_, blocks_y_) + 1;
        for (int ring = 0; ring <= last_ring; ++ring) {
            // Blocks at an edge of the map may be narrow; a ring crosses at most two of them.
            const auto reach = static_cast<float>(std::max(ring - 3, 0) * kConeBlock) * texel;
            if (reach >= best * depth) {
                break;
            }
            for (int j = -ring; j <= ring; ++j) {
                const int step = std::abs(j) == ring ? 1 : std::max(2 * ring, 1);
                for (int i = -ring; i <= ring; i += step) {
                    visit_block(x, y, depth, bx + i, by + j, best);
                }
            }
        }
        return best;
    }

  private:
    /// Narrows `best` to the cone that a ray over the texel at (dx, dy) from (x, y) leaves room
    /// for.
    void visit(int x, int y, float depth, int dx, int dy, float& best) const {
        const float entry = depth_at(x + dx, y + dy);
        const Vec2 offset = {
            static_cast<float>(dx) / static_cast<float>(width_),
            static_cast<float>(dy) / static_cast<float>(height_)};
        const float distance = std::sqrt(offset.x * offset.x + offset.y * offset.y);
        if (distance >= best * (depth - entry)) {
            return;
        }
        const auto texels = static_cast<float>(std::max(std::abs(dx), std::abs(dy)));
        const float step = kConeStep / texels;
        const auto is_out = [&](float s) {
            return smooth_depth(
                       static_cast<float>(x) + s * static_cast<float>(dx),
                       static_cast<float>(y) + s * static_cast<float>(dy))
                   > entry * s;
        };
        // As long as the point before may still be in the cone, so that the order of texels does
        // not matter.
        for (float s = 1 + step; distance * (s - step) < best * (depth - entry * (s - step));
             s += step) {
            if (!is_out(s)) {
                continue;
            }
            float inside = s - step;
            float outside = s;
            for (int i = 0; i < 4; ++i) {
                const float middle = 0.5f * (inside + outside);
                (is_out(middle) ? outside : inside) = middle;
            }
            best = std::min(best, distance * inside / (depth - entry * inside));
            return;
        }  // else it leaves the surface outside the cone, or below the apex
    }

    [[nodiscard]] float depth_at(int x, int y) const {
        const int wx =
            repeats_ ? x - width_ * floor_divide(x, width_) : std::clamp(x, 0, width_ - 1);
        const int wy =
            repeats_ ? y - height_ * floor_divide(y, height_) : std::clamp(y, 0, height_ - 1);
        return depths_
            [static_cast<std::size_t>(wy) * static_cast<std::size_t>(width_)
             + static_cast<std::size_t>(wx)];
    }

    [[nodiscard]] std::size_t block_at(int bx, int by) const {
        return static_cast<std::size_t>(by) * static_cast<std::size_t>(blocks_x_)
               + static_cast<std::size_t>(bx);
    }

    /// Between the texels' centers, which are at whole numbers here.
    [[nodiscard]] float smooth_depth(float x, float y) const {
        const float fx = std::floor(x);
        const float fy = std::floor(y);
        const int ix = static_cast<int>(fx);
        const int iy = static_cast<int>(fy);
        const float u = x - fx;
        const float v = y - fy;
        const float top = depth_at(ix, iy) * (1 - u) + depth_at(ix + 1, iy) * u;
        const float bottom = depth_at(ix, iy + 1) * (1 - u) + depth_at(ix + 1, iy + 1) * u;
        return top * (1 - v) + bottom * v;
    }

    void visit_block(int x, int y, float depth, int bx, int by, float& best) const {
        const int tile_x = floor_divide(bx, blocks_x_);
        const int tile_y = floor_divide(by, blocks_y_);
        if (!repeats_ && (tile_x != 0 || tile_y != 0)) {
            return;
        }
        const int local_x = bx - tile_x * blocks_x_;
        const int local_y = by - tile_y * blocks_y_;
        const int low_x = tile_x * width_ + local_x * kConeBlock;
        const int low_y = tile_y * height_ + local_y * kConeBlock;
        const int high_x =
            tile_x * width_ + std::min((local_x + 1) * kConeBlock, width_);  // beyond
        const int high_y = tile_y * height_ + std::min((local_y + 1) * kConeBlock, height_);
        const auto gap = [](int at, int low, int high) {
            return static_cast<float>(std::max({low - at, at - (high - 1), 0}));
        };
        const float gap_x = gap(x, low_x, high_x) / static_cast<float>(width_);
        const float gap_y = gap(y, low_y, high_y) / static_cast<float>(height_);
        const float room = best * (depth - least_[block_at(local_x, local_y)]);
        if (room <= 0 || gap_x * gap_x + gap_y * gap_y >= room * room) {
            return;
        }
        for (int j = low_y; j < high_y; ++j) {
            for (int i = low_x; i < high_x; ++i) {
                if (i != x || j != y) {
                    visit(x, y, depth, i - x, j - y, best);
                }
            }
        }
    }

    int width_ = 0;
    int height_ = 0;
    bool repeats_ = true;
    int blocks_x_ = 0;
    int blocks_y_ = 0;
    std::vector<float> depths_;
    std::vector<float> least_;  ///< depth in each block
};

}  // namespace

BakedMap
make_cone_map(const BakedMap& relief, bool repeats, const RowProgress& progress, float widest) {
    const ConeBaker baker(relief, repeats);
    BakedMap cones = relief;
    bake_rows(relief.height, progress, [&](int y) {
        for (int x = 0; x < relief.width; ++x) {
            cones.texels[cones.at(x, y)].z = baker.ratio(x, y, widest);
        }
    });
    return cones;
}

}  // namespace limn
