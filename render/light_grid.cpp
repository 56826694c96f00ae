#include "render/light_grid.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace limn {
namespace {

/// Cells are widened by this share: the GPU's log2 and ours differ in the last bits.
constexpr float kSlack = 1e-3f;
constexpr float kFarthest = 1e12f;  ///< [m]; the last slice goes on for ever

/// Of a cell, in view space with z as distance along the axis.
struct CellBox {
    Vec3 min;
    Vec3 max;
};

struct Range {
    int begin = 0;
    int end = 0;  ///< exclusive
};

/// In view space: x right, y up, z along the axis.
Vec3 to_view(const Affine& world_from_camera, const Vec3& v) {
    const auto& r = world_from_camera.row;
    return {
        r[0].x * v.x + r[1].x * v.y + r[2].x * v.z,
        r[0].y * v.x + r[1].y * v.y + r[2].y * v.z,
        -(r[0].z * v.x + r[1].z * v.y + r[2].z * v.z)};
}

float distance_squared(const Vec3& p, const CellBox& box) {
    const Vec3 nearest = glm::clamp(p, box.min, box.max);
    return glm::dot(p - nearest, p - nearest);
}

/// Whether the cone (apex at the origin, unit `axis`) and the sphere about `center` certainly do
/// not touch (Wronski 2017).
bool outside_cone(const Vec3& center, float radius, const Vec3& axis, float cosine) {
    const float along = glm::dot(center, axis);
    const float across = std::sqrt(std::max(glm::dot(center, center) - along * along, 0.0f));
    const float sine = std::sqrt(std::max(1.0f - cosine * cosine, 0.0f));
    return cosine * across - along * sine > radius * (1 + kSlack) || along < -radius * (1 + kSlack);
}

class GridBuilder {
  public:
    GridBuilder(const RenderView& view, const LightGridShape& shape) : view_(view), shape_(shape) {
        const Vec2 pixel = 2.0f * view.tangent / Vec2(view.width, view.height);
        for (int c = 0; c <= shape.columns; ++c) {
            slope_x_.push_back(slope(c, pixel.x, view.tangent.x, view.jitter.x));
        }
        for (int r = 0; r <= shape.rows; ++r) {
            slope_y_.push_back(slope(r, pixel.y, view.tangent.y, view.jitter.y));
        }
        for (int s = 0; s <= shape.slices; ++s) {
            const float z =
                std::exp2((static_cast<float>(s) - shape.depth_bias) / shape.depth_scale);
            slice_z_.push_back(z);
        }
        slice_z_.front() = 0;
        slice_z_.back() = kFarthest;
    }

    /// Calls use(cell) for every cell that the light may touch, in order.
    template <typename Use>
    void each_cell(const LightReach& reach, Use&& use) const {
        const Vec3 position = {
            reach.center.x - view_.world_from_camera.row[0].w,
            reach.center.y - view_.world_from_camera.row[1].w,
            reach.center.z - view_.world_from_camera.row[2].w};
        const Vec3 center = to_view(view_.world_from_camera, position);
        const Vec3 axis = to_view(view_.world_from_camera, reach.axis);
        const bool endless = !(reach.radius < kFarthest);
        const float radius2 = square(reach.radius * (1 + kSlack));
        for (int s = 0; s < shape_.slices; ++s) {
            const float z0 = slice_z_[s] * (1 - kSlack);
            const float z1 = slice_z_[s + 1] * (1 + kSlack);
            if (!endless && (center.z + reach.radius < z0 || center.z - reach.radius > z1)) {
                continue;
            }
            const Range rows = touched(slope_y_, center.y, endless, radius2, z0, z1);
            const Range columns = touched(slope_x_, center.x, endless, radius2, z0, z1);
            for (int r = rows.begin; r < rows.end; ++r) {
                for (int c = columns.begin; c < columns.end; ++c) {
                    const CellBox box = cell_box(c, r, z0, z1);
                    if (endless || distance_squared(center, box) <= radius2) {
                        const Vec3 middle = 0.5f * (box.min + box.max);
                        const float half = glm::length(0.5f * (box.max - box.min));
                        if (reach.cosine <= -1 || s + 1 == shape_.slices
                            || !outside_cone(middle - center, half, axis, reach.cosine)) {
                            use((s * shape_.rows + r) * shape_.columns + c);
                        }
                    }
                }
            }
        }
    }

  private:
    /// x / z of the tile edge `edge` tiles from the left (or bottom).
    float slope(int edge, float pixel, float tangent, float jitter) const {
        return (static_cast<float>(edge * shape_.tile) - jitter) * pixel - tangent;
    }

    static float low(float slope, float z0, float z1) { return slope * (slope < 0 ? z1 : z0); }
    static float high(float slope, float z0, float z1) { return slope * (slope < 0 ? z0 : z1); }

    /// Tiles along one axis that the sphere may touch between z0 and z1.
    static Range touched(
        const std::vector<float>& slopes,
        float center,
        bool endless,
        float radius2,
        float z0,
        float z1) {
        const int count = static_cast<int>(slopes.size()) - 1;
        Range range = {0, count};
        if (!endless) {
            const auto apart = [&](int tile) {
                const float min = low(slopes[tile], z0, z1);
                const float max = high(slopes[tile + 1], z0, z1);
                return square(center - std::clamp(center, min, std::max(min, max))) > radius2;
            };
            while (range.begin < range.end && apart(range.begin)) {
                ++range.begin;
            }
            while (range.end > range.begin && apart(range.end - 1)) {
                --range.end;
            }
        }
        return range;
    }

    [[nodiscard]] CellBox cell_box(int column, int row, float z0, float z1) const {
        return {
            {low(slope_x_[column], z0, z1), low(slope_y_[row], z0, z1), z0},
            {high(slope_x_[column + 1], z0, z1), high(slope_y_[row + 1], z0, z1), z1}};
    }

    const RenderView& view_;
    const LightGridShape& shape_;
    std::vector<float> slope_x_;
    std::vector<float> slope_y_;
    std::vector<float> slice_z_;
};

}  // namespace

LightGridShape make_grid_shape(const RenderView& view, std::span<const LightReach> reach) {
    LightGridShape shape;
    shape.columns = (view.width + shape.tile - 1) / shape.tile;
    shape.rows = (view.height + shape.tile - 1) / shape.tile;
    float farthest = view.near * 100;
    for (const LightReach& light : reach) {
        const Vec3 offset = {
            light.center.x - view.world_from_camera.row[0].w,
            light.center.y - view.world_from_camera.row[1].w,
            light.center.z - view.world_from_camera.row[2].w};
        const float end = to_view(view.world_from_camera, offset).z + light.radius;
        farthest = std::isfinite(end) ? std::max(farthest, end) : farthest;
    }
    farthest = std::min(farthest, 0.5f * kFarthest);
    // A hundredth of the whole depth is near enough for the first slice.
    const float nearest = std::max(view.near, farthest * 0.01f);
    shape.depth_scale = static_cast<float>(shape.slices - 1) / std::log2(farthest / nearest);
    shape.depth_bias = 1.0f - shape.depth_scale * std::log2(nearest);
    return shape;
}

void build_light_grid(const RenderView& view, const LightList& lights, LightGrid& grid) {
    grid.shape = make_grid_shape(view, lights.reach);
    const GridBuilder builder(view, grid.shape);
    const auto first = static_cast<layout::uint>(lights.directional);

    // Count, sum, fill: every list ends in the order of the lights.
    grid.cells.assign(
        static_cast<std::size_t>(grid.shape.columns) * grid.shape.rows * grid.shape.slices, {0, 0});
    grid.touched.clear();
    for (std::size_t i = 0; i < lights.reach.size(); ++i) {
        builder.each_cell(lights.reach[i], [&](int cell) {
            ++grid.cells[cell].y;
            grid.touched.push_back(
                {static_cast<layout::uint>(cell), first + static_cast<layout::uint>(i)});
        });
    }
    layout::uint total = 0;
    for (layout::uvec2& cell : grid.cells) {
        cell.x = total;
        total += cell.y;
        cell.y = 0;
    }
    grid.indices.resize(total);
    for (const layout::uvec2& found : grid.touched) {
        layout::uvec2& list = grid.cells[found.x];
        grid.indices[list.x + list.y++] = found.y;
    }
}

int cell_of(const LightGridShape& shape, float pixel_x, float pixel_y, float distance) {
    const int column = static_cast<int>(pixel_x) / shape.tile;
    const int row = static_cast<int>(pixel_y) / shape.tile;
    const float slice = std::floor(std::log2(distance) * shape.depth_scale + shape.depth_bias);
    const int clamped =
        static_cast<int>(std::clamp(slice, 0.0f, static_cast<float>(shape.slices - 1)));
    return (clamped * shape.rows + row) * shape.columns + column;
}

}  // namespace limn
