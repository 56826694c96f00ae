#include "systems/water/water_ripple_walls.h"

#include "systems/water/water_ripple_grid.h"
#include "systems/water/water_shape.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace limn {

namespace {

constexpr float kBulgeScale =
    2.0f;                   ///< extent of the water raised by a wall, relative to its half extents
constexpr float kEdge = 4;  ///< weight of an edge in the Laplacian, in sixths of cell^-2
constexpr float kCorner = 1;

bool same(const PlacedWall& a, const PlacedWall& b) {
    return a.shape == b.shape && a.shape_from_water.row[0] == b.shape_from_water.row[0]
           && a.shape_from_water.row[1] == b.shape_from_water.row[1]
           && a.shape_from_water.row[2] == b.shape_from_water.row[2] && a.volume == b.volume;
}

/// Number of walls equal to this one among the first `count`, or among all.
std::ptrdiff_t
count_of(std::span<const PlacedWall> walls, const PlacedWall& wall, std::size_t count = SIZE_MAX) {
    const std::span<const PlacedWall> first = walls.first(std::min(count, walls.size()));
    return std::count_if(
        first.begin(), first.end(), [&](const PlacedWall& other) { return same(other, wall); });
}

/// Calls `each` with the multiset difference `these` - `those`.
template <typename Each>
void each_missing(
    std::span<const PlacedWall> these, std::span<const PlacedWall> those, Each&& each) {
    for (std::size_t i = 0; i < these.size(); ++i) {
        if (count_of(these, these[i], i + 1) > count_of(those, these[i])) {
            each(these[i]);
        }
    }
}

/// Half extents of the section along the axes of the shape: 1, or half a cell so that no gap is
/// left between cell centers.
Vec3 widened(const PlacedWall& wall, float cell) {
    Vec3 half(1);
    for (int i = 0; i < 3 && wall.shape == WallShape::Box; ++i) {
        const Vec4& row = wall.shape_from_water.row[i];
        half[i] = std::max(half[i], 0.5005f * cell * (std::abs(row.x) + std::abs(row.z)));
    }
    return half;
}

bool is_in_wall(const PlacedWall& wall, const Vec3& half, const Vec2& at) {
    const Vec3 p = glm::abs(transform_point(wall.shape_from_water, {at.x, 0, at.y}));
    switch (wall.shape) {
    case WallShape::Box:
        return p.x <= half.x && p.y <= half.y && p.z <= half.z;
    case WallShape::Cylinder:
        return p.y <= 1 && p.x * p.x + p.z * p.z <= 1;
    case WallShape::Ball:
        return glm::dot(p, p) <= 1;
    }
    return false;
}

std::vector<std::uint8_t> dry_cells(const RippleState& state, std::span<const PlacedWall> walls) {
    std::vector<std::uint8_t> dry(state.height.size());
    bool any = false;
    for (const PlacedWall& wall : walls) {
        const Vec3 half = widened(wall, state.cell);
        const CellBox box = box_around(state, wall.center, wall.half_extent + 2 * state.cell);
        for (int z = box.first.y; z < box.last.y; ++z) {
            for (int x = box.first.x; x < box.last.x; ++x) {
                if (is_in_wall(wall, half, cell_center(state, x, z))) {
                    dry[state.at(x, z)] = 1;
                    any = true;
                }
            }
        }
    }
    if (!any) {
        dry.clear();
    }
    return dry;
}

/// Calls body(x, z, index) for each water cell.
template <typename Body>
void each_wet(const RippleState& state, Body&& body) {
    for (int z = 0; z < state.cells.y; ++z) {
        for (int x = 0; x < state.cells.x; ++x) {
            if (!is_dry(state, state.at(x, z))) {
                body(x, z, state.at(x, z));
            }
        }
    }
}

/// Offsets to the neighbors of a cell, edge neighbors first.
constexpr IVec2 kAround[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};

bool is_on_grid(const RippleState& state, const IVec2& cell) {
    return cell.x >= 0 && cell.y >= 0 && cell.x < state.cells.x && cell.y < state.cells.y;
}

/// Weight of the exchange between two neighbors. Beyond the grid there is a wall or open water;
/// `walls`: whether to include the walls in the field.
float exchange(const RippleState& state, const IVec2& a, const IVec2& b, bool walls) {
    const auto wet = [&](const IVec2& cell) {
        return is_on_grid(state, cell) ? !(walls && is_dry(state, state.at(cell.x, cell.y)))
                                       : state.wall_border == RippleBorder::Absorbing;
    };
    if (!wet(a) || !wet(b)) {
        return 0;
    }
    const IVec2 step = b - a;
    if (step.x != 0 && step.y != 0) {
        const bool beside = wet({a.x + step.x, a.y}) || wet({a.x, a.y + step.y});
        return beside ? kCorner : 0;
    }
    const IVec2 side = {step.y, step.x};
    const auto mirrored = [&](const IVec2& s) { return !wet(a + s) && !wet(b + s) ? kCorner : 0; };
    return kEdge + mirrored(side) + mirrored(-side);
}

void make_faces(RippleState& state, std::span<const IVec2> dry) {
    state.faces.clear();
    state.row.clear();
    if (state.dry.empty()) {
        return;
    }
    std::vector<std::uint8_t> beside(state.dry.size());  // 1 for water cells next to a wall
    for (const IVec2& cell : dry) {
        for (const IVec2& to : kAround) {
            const std::size_t other = state.at(cell.x + to.x, cell.y + to.y);
            beside[other] = is_on_grid(state, cell + to) && state.dry[other] == 0;
        }
    }
    for (int z = 0; z < state.cells.y; ++z) {
        state.row.push_back(static_cast<std::uint32_t>(state.faces.size()));
        for (int x = 0; x < state.cells.x; ++x) {
            const std::size_t at = state.at(x, z);
            for (int i = 0; i < 8 && beside[at] != 0; ++i) {
                const IVec2 cell = {x, z};
                const IVec2 other = cell + kAround[i];
                if (!is_on_grid(state, other)) {
                    continue;
                }
                const float change =
                    exchange(state, cell, other, true) - exchange(state, cell, other, false);
                if (change != 0) {
                    state.faces.push_back(
                        {static_cast<std::uint32_t>(at),
                         static_cast<std::uint32_t>(state.at(other.x, other.y)), change});
                }
            }
        }
    }
    state.row.push_back(static_cast<std::uint32_t>(state.faces.size()));
}

/// Dry cells next to water copy its mean, those behind them the mean of these. The next layer is
/// zeroed after each substep, so that the kernel's exchanges between dry cells spread no farther.
void make_rims(RippleState& state, std::span<const IVec2> dry) {
    state.wall_cells.clear();
    if (state.dry.empty()) {
        return;
    }
    std::vector<std::uint8_t> layer(state.dry.size(), 1);  // 1 water, 2 next to it ...; 0 inside
    for (const IVec2& cell : dry) {
        layer[state.at(cell.x, cell.y)] = 0;
    }
    for (std::uint8_t now = 2; now <= 4; ++now) {
        for (const IVec2& cell : dry) {
            const std::size_t at = state.at(cell.x, cell.y);
            const auto index = static_cast<std::uint32_t>(at);
            std::uint32_t from[8];
            int count = 0;
            for (int i = 0; i < 8 && layer[at] == 0; ++i) {
                const IVec2 beside = cell + kAround[i];
                const std::size_t other = state.at(beside.x, beside.y);
                if (i == 4 && count > 0) {
                    break;  // has edge neighbors
                }
                if (is_on_grid(state, beside) && layer[other] == now - 1) {
                    from[count++] = static_cast<std::uint32_t>(other);
                }
            }
            if (count == 0) {
                continue;
            }
            layer[at] = now;
            state.wall_cells.push_back({index, index, 0});
            for (int i = 0; i < count && now < 4; ++i) {
                state.wall_cells.push_back({index, from[i], 1.0f / static_cast<float>(count)});
            }
        }
    }
}

std::vector<IVec2> cells_that_are_dry(const RippleState& state) {
    std::vector<IVec2> dry;
    for (int z = 0; z < state.cells.y && !state.dry.empty(); ++z) {
        for (int x = 0; x < state.cells.x; ++x) {
            if (state.dry[state.at(x, z)] != 0) {
                dry.push_back({x, z});
            }
        }
    }
    return dry;
}

void make_lists(RippleState& state, std::span<const IVec2> dry) {
    make_faces(state, dry);
    make_rims(state, dry);
}

/// Empties cells that became dry and fills those that are no longer dry to the level of adjacent
/// water; the adjacent cells share the difference, which conserves volume. `field` has heights for
/// the dry cells `was`.
void move_water(
    const RippleState& state, const std::vector<std::uint8_t>& was, std::vector<float>& field) {
    if (was == state.dry) {
        return;
    }
    const auto was_dry = [&](std::size_t at) { return !was.empty() && was[at] != 0; };
    std::vector<std::size_t> beside;
    std::vector<std::size_t> comes;
    std::vector<std::size_t> goes;
    for (int z = 0; z < state.cells.y; ++z) {
        for (int x = 0; x < state.cells.x; ++x) {
            const std::size_t at = state.at(x, z);
            if (is_dry(state, at) == was_dry(at)) {
                continue;
            }
            (is_dry(state, at) ? comes : goes).push_back(at);
            for (const IVec2& to : kAround) {
                const IVec2 cell = IVec2(x, z) + to;
                const std::size_t other = state.at(cell.x, cell.y);
                if (is_on_grid(state, cell) && !is_dry(state, other) && !was_dry(other)) {
                    beside.push_back(other);
                }
            }
        }
    }
    std::sort(beside.begin(), beside.end());
    beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
    double level = 0;
    for (const std::size_t at : beside) {
        level += static_cast<double>(field[at]) / static_cast<double>(beside.size());
    }
    double excess = 0;
    for (const std::size_t at : comes) {
        excess += static_cast<double>(std::exchange(field[at], 0.0f));
    }
    for (const std::size_t at : goes) {
        field[at] = static_cast<float>(level);
        excess -= static_cast<double>(field[at]);
    }
    if (beside.empty()) {
        each_wet(state, [&](int, int, std::size_t at) { beside.push_back(at); });
    }
    for (const std::size_t at : beside) {
        field[at] += static_cast<float>(excess / static_cast<double>(beside.size()));
    }
}

/// Raises the water around a wall by `fraction` of its volume; if there is none nearby, all water.
void raise(RippleState& state, const PlacedWall& wall, float fraction) {
    const Vec2 radius = glm::max(kBulgeScale * wall.half_extent, Vec2(2.5f * state.cell));
    double weights = 0;
    each_bump_cell(state, wall.center, radius, [&](std::size_t, float weight, int, int) {
        weights += static_cast<double>(weight);
    });
    const double volume = static_cast<double>(fraction * wall.volume);
    const double height = volume / (static_cast<double>(state.cell) * state.cell);
    state.wall_volume += volume;
    const auto lift = [&](std::size_t at, float by) {
        state.height[at] += by;
        state.previous[at] += by;
    };
    if (!(weights > 0)) {
        const auto each = static_cast<float>(height / std::max(state.wet, 1));
        each_wet(state, [&](int, int, std::size_t at) { lift(at, each); });
        return;
    }
    const auto peak = static_cast<float>(height / weights);
    each_bump_cell(state, wall.center, radius, [&](std::size_t at, float weight, int, int) {
        lift(at, peak * weight);
    });
}

/// Removes the displacement by bodies; displace_ripples adds it again.
void lower_bodies(RippleState& state) {
    for (std::size_t i = 0; i < state.body.size(); ++i) {
        state.height[i] -= state.body[i];
        state.previous[i] -= state.body[i];
    }
    state.body.clear();
}

}  // namespace

std::optional<PlacedWall> place_wall(
    const WaterWall& wall, const Affine& world, const WaterFrame& frame, float depth,
    const Vec2& extent) {
    const WaterShape shape = place_shape(wall.shape, wall.half, wall.offset, world, frame);
    const Mat3 axes(shape.axes[0], shape.axes[1], shape.axes[2]);
    const float check = glm::dot(shape.center, Vec3(1)) + shape.volume
                        + glm::dot(shape.half_extent, Vec3(1)) + 1 / glm::determinant(axes);
    if (!std::isfinite(check) || shape.center.y > shape.half_extent.y) {
        return std::nullopt;
    }
    // Only the fraction inside the field displaces water.
    float fraction = 1;
    for (const int axis : {0, 2}) {
        const float half = 0.5f * extent[axis / 2];
        const float from = std::max(shape.center[axis] - shape.half_extent[axis], -half);
        const float to = std::min(shape.center[axis] + shape.half_extent[axis], half);
        fraction *= std::max(to - from, 0.0f) / (2 * shape.half_extent[axis]);
    }
    if (!(fraction > 0)) {
        return std::nullopt;
    }
    const Mat3 inverse = glm::inverse(axes);
    PlacedWall placed;
    placed.shape = wall.shape;
    const Vec3 origin = inverse * shape.center;
    for (int i = 0; i < 3; ++i) {
        placed.shape_from_water.row[i] = {inverse[0][i], inverse[1][i], inverse[2][i], -origin[i]};
    }
    placed.center = {shape.center.x, shape.center.z};
    placed.half_extent = {shape.half_extent.x, shape.half_extent.z};
    placed.volume =
        fraction * (volume_below(shape, 0) - (depth > 0 ? volume_below(shape, -depth) : 0.0f));
    return placed;
}

void set_ripple_walls(RippleState& state, std::span<const PlacedWall> walls, RippleBorder border) {
    if (state.cells.x == 0
        || (state.walls.size() == walls.size() && state.wall_border == border
            && std::equal(walls.begin(), walls.end(), state.walls.begin(), same))) {
        if (!state.dry.empty() && state.row.empty()) {
            make_lists(state, cells_that_are_dry(state));  // restored from a snapshot
        }
        return;
    }
    const double texel = static_cast<double>(state.cell) * state.cell;
    const double displaced =  // by bodies
        state.wet > 0 ? state.level * texel * state.wet - state.wall_volume : 0;
    lower_bodies(state);
    const std::vector<std::uint8_t> was = std::exchange(state.dry, dry_cells(state, walls));
    const std::int32_t were_wet = state.wet;
    const std::vector<IVec2> dry = cells_that_are_dry(state);
    state.wet = state.cells.x * state.cells.y - static_cast<std::int32_t>(dry.size());
    state.wall_border = border;
    move_water(state, was, state.height);
    move_water(state, was, state.previous);
    if (state.steps > 0) {
        const std::vector<PlacedWall>& old = state.walls;
        each_missing(old, walls, [&](const PlacedWall& wall) { raise(state, wall, -1); });
        each_missing(walls, old, [&](const PlacedWall& wall) { raise(state, wall, 1); });
    }
    state.level = state.wet > 0 ? (displaced + state.wall_volume) / (texel * state.wet) : 0;
    for (std::vector<float>* const field : {&state.height, &state.previous}) {
        for (const IVec2& cell : dry) {
            (*field)[state.at(cell.x, cell.y)] = 0;
        }
        if (were_wet == 0) {  // there was no water to conserve
            each_wet(state, [&](int, int, std::size_t at) {
                (*field)[at] = static_cast<float>(state.level);
            });
        }
    }
    state.walls.assign(walls.begin(), walls.end());
    make_lists(state, dry);
    fill_wall_cells(state, state.height);
    fill_wall_cells(state, state.previous);
}

void apply_wall_faces(RippleState& state, std::size_t begin, std::size_t end, float factor) {
    if (state.faces.empty()) {
        return;
    }
    const float* const height = state.height.data();
    float* const next = state.previous.data();
    for (std::uint32_t i = state.row[begin]; i < state.row[end]; ++i) {
        const RippleLink& face = state.faces[i];
        next[face.at] += factor * face.weight * (height[face.other] - height[face.at]);
    }
}

void fill_wall_cells(const RippleState& state, std::vector<float>& field) {
    for (const RippleLink& rim : state.wall_cells) {
        field[rim.at] = rim.weight > 0 ? field[rim.at] + rim.weight * field[rim.other]
                                       : 0.0f;  // weight 0 comes first
    }
}

}  // namespace limn
