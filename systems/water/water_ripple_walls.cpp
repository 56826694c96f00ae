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

constexpr float kBulgeReach = 2.0f;  ///< of what a wall raises, in its half extents
constexpr float kEdge = 4;           ///< share of an edge in the Laplacian, in sixths of a cell^-2
constexpr float kCorner = 1;

bool same(const PlacedWall& a, const PlacedWall& b) {
    return a.shape == b.shape && a.shape_from_water.row[0] == b.shape_from_water.row[0]
           && a.shape_from_water.row[1] == b.shape_from_water.row[1]
           && a.shape_from_water.row[2] == b.shape_from_water.row[2] && a.volume == b.volume;
}

/// How many of the first `count` walls, or of all, are the same as this one.
std::ptrdiff_t
count_of(std::span<const PlacedWall> walls, const PlacedWall& wall, std::size_t count = SIZE_MAX) {
    const std::span<const PlacedWall> first = walls.first(std::min(count, walls.size()));
    return std::count_if(
        first.begin(), first.end(), [&](const PlacedWall& other) { return same(other, wall); });
}

/// Calls `each` with the walls of `these` that are not among `those`, equal ones one for one.
template <typename Each>
void each_missing(
    std::span<const PlacedWall> these, std::span<const PlacedWall> those, Each&& each) {
    for (std::size_t i = 0; i < these.size(); ++i) {
        if (count_of(these, these[i], i + 1) > count_of(those, these[i])) {
            each(these[i]);
        }
    }
}

/// How far from its middle a section counts, along the axes of the shape: 1, or half a cell's
/// width so that no gap is left between the middles of cells.
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
        const CellBox box = box_around(state, wall.center, wall.reach + 2 * state.cell);
        for (int z = box.first.y; z < box.last.y; ++z) {
            for (int x = box.first.x; x < box.last.x; ++x) {
                if (is_in_wall(wall, half, middle_of(state, x, z))) {
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

/// body(x, z, place) for each cell that is water.
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

/// The cells around one that are on the grid, those at its edges first.
constexpr IVec2 kAround[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};

bool is_on_grid(const RippleState& state, const IVec2& cell) {
    return cell.x >= 0 && cell.y >= 0 && cell.x < state.cells.x && cell.y < state.cells.y;
}

/// How much two neighbors exchange. Beyond the grid there is a wall, or more water; `walls`: with
/// those that stand in it.
float exchange(const RippleState& state, const IVec2& a, const IVec2& b, bool walls) {
    const auto wet = [&](const IVec2& cell) {
        return is_on_grid(state, cell) ? !(walls && is_dry(state, state.at(cell.x, cell.y)))
                                       : state.wall_border == RippleBorder::Absorbing;
    };
    if (!wet(a) || !wet(b)) {
        return 0;
    }
    const IVec2 way = b - a;
    if (way.x != 0 && way.y != 0) {
        const bool beside = wet({a.x + way.x, a.y}) || wet({a.x, a.y + way.y});
        return beside ? kCorner : 0;
    }
    const IVec2 side = {way.y, way.x};
    const auto mirrored = [&](const IVec2& s) { return !wet(a + s) && !wet(b + s) ? kCorner : 0; };
    return kEdge + mirrored(side) + mirrored(-side);
}

void make_faces(RippleState& state, std::span<const IVec2> dry) {
    state.faces.clear();
    state.row.clear();
    if (state.dry.empty()) {
        return;
    }
    std::vector<std::uint8_t> beside(state.dry.size());  // 1 of water beside a wall
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

/// Dry cells beside water repeat the mean of it, those behind them the mean of these. The next are
/// made level after each sub-step, so that what the kernel does between dry cells goes no farther.
void make_rims(RippleState& state, std::span<const IVec2> dry) {
    state.rims.clear();
    if (state.dry.empty()) {
        return;
    }
    std::vector<std::uint8_t> layer(state.dry.size(), 1);  // 1 water, 2 beside it ...; 0 inside
    for (const IVec2& cell : dry) {
        layer[state.at(cell.x, cell.y)] = 0;
    }
    for (std::uint8_t now = 2; now <= 4; ++now) {
        for (const IVec2& cell : dry) {
            const std::size_t at = state.at(cell.x, cell.y);
            const auto place = static_cast<std::uint32_t>(at);
            std::uint32_t from[8];
            int count = 0;
            for (int i = 0; i < 8 && layer[at] == 0; ++i) {
                const IVec2 beside = cell + kAround[i];
                const std::size_t other = state.at(beside.x, beside.y);
                if (i == 4 && count > 0) {
                    break;  // has one at an edge
                }
                if (is_on_grid(state, beside) && layer[other] == now - 1) {
                    from[count++] = static_cast<std::uint32_t>(other);
                }
            }
            if (count == 0) {
                continue;
            }
            layer[at] = now;
            state.rims.push_back({place, place, 0});
            for (int i = 0; i < count && now < 4; ++i) {
                state.rims.push_back({place, from[i], 1.0f / static_cast<float>(count)});
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

/// Cells that have become dry lose their water, those that no longer are get it as high as beside
/// them: the cells beside them share the difference, so that none is made or lost. In `field`,
/// which has the heights of water between the walls of `was`.
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
    double homeless = 0;
    for (const std::size_t at : comes) {
        homeless += static_cast<double>(std::exchange(field[at], 0.0f));
    }
    for (const std::size_t at : goes) {
        field[at] = static_cast<float>(level);
        homeless -= static_cast<double>(field[at]);
    }
    if (beside.empty()) {
        each_wet(state, [&](int, int, std::size_t at) { beside.push_back(at); });
    }
    for (const std::size_t at : beside) {
        field[at] += static_cast<float>(homeless / static_cast<double>(beside.size()));
    }
}

/// Raises the water about a wall by `share` of its volume, or all of it where there is none near.
void raise(RippleState& state, const PlacedWall& wall, float share) {
    const Vec2 radius = glm::max(kBulgeReach * wall.reach, Vec2(2.5f * state.cell));
    double weights = 0;
    each_bump_cell(state, wall.center, radius, [&](std::size_t, float weight, int, int) {
        weights += static_cast<double>(weight);
    });
    const double volume = static_cast<double>(share * wall.volume);
    const double height = volume / (static_cast<double>(state.cell) * state.cell);
    state.walled += volume;
    const auto lift = [&](std::size_t at, float by) {
        state.height[at] += by;
        state.before[at] += by;
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

/// Takes the rise of bodies back, for displace_ripples to make anew.
void lower_bodies(RippleState& state) {
    for (std::size_t i = 0; i < state.body.size(); ++i) {
        state.height[i] -= state.body[i];
        state.before[i] -= state.body[i];
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
                        + glm::dot(shape.reach, Vec3(1)) + 1 / glm::determinant(axes);
    if (!std::isfinite(check) || shape.center.y > shape.reach.y) {
        return std::nullopt;
    }
    // Of what reaches beyond the field, the share that is in it makes room.
    float share = 1;
    for (const int axis : {0, 2}) {
        const float half = 0.5f * extent[axis / 2];
        const float from = std::max(shape.center[axis] - shape.reach[axis], -half);
        const float to = std::min(shape.center[axis] + shape.reach[axis], half);
        share *= std::max(to - from, 0.0f) / (2 * shape.reach[axis]);
    }
    if (!(share > 0)) {
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
    placed.reach = {shape.reach.x, shape.reach.z};
    placed.volume =
        share * (volume_below(shape, 0) - (depth > 0 ? volume_below(shape, -depth) : 0.0f));
    return placed;
}

void set_ripple_walls(RippleState& state, std::span<const PlacedWall> walls, RippleBorder border) {
    if (state.cells.x == 0
        || (state.walls.size() == walls.size() && state.wall_border == border
            && std::equal(walls.begin(), walls.end(), state.walls.begin(), same))) {
        if (!state.dry.empty() && state.row.empty()) {
            make_lists(state, cells_that_are_dry(state));  // it comes from a snapshot
        }
        return;
    }
    const double texel = static_cast<double>(state.cell) * state.cell;
    const double displaced =  // by bodies
        state.wet > 0 ? state.level * texel * state.wet - state.walled : 0;
    lower_bodies(state);
    const std::vector<std::uint8_t> was = std::exchange(state.dry, dry_cells(state, walls));
    const std::int32_t were_wet = state.wet;
    const std::vector<IVec2> dry = cells_that_are_dry(state);
    state.wet = state.cells.x * state.cells.y - static_cast<std::int32_t>(dry.size());
    state.wall_border = border;
    move_water(state, was, state.height);
    move_water(state, was, state.before);
    if (state.steps > 0) {
        const std::vector<PlacedWall>& old = state.walls;
        each_missing(old, walls, [&](const PlacedWall& wall) { raise(state, wall, -1); });
        each_missing(walls, old, [&](const PlacedWall& wall) { raise(state, wall, 1); });
    }
    state.level = state.wet > 0 ? (displaced + state.walled) / (texel * state.wet) : 0;
    for (std::vector<float>* const field : {&state.height, &state.before}) {
        for (const IVec2& cell : dry) {
            (*field)[state.at(cell.x, cell.y)] = 0;
        }
        if (were_wet == 0) {  // there was no water left to keep
            each_wet(state, [&](int, int, std::size_t at) {
                (*field)[at] = static_cast<float>(state.level);
            });
        }
    }
    state.walls.assign(walls.begin(), walls.end());
    make_lists(state, dry);
    fill_rims(state, state.height);
    fill_rims(state, state.before);
}

void close_faces(RippleState& state, std::size_t begin, std::size_t end, float factor) {
    if (state.faces.empty()) {
        return;
    }
    const float* const height = state.height.data();
    float* const next = state.before.data();
    for (std::uint32_t i = state.row[begin]; i < state.row[end]; ++i) {
        const RippleLink& face = state.faces[i];
        next[face.at] += factor * face.weight * (height[face.other] - height[face.at]);
    }
}

void fill_rims(const RippleState& state, std::vector<float>& field) {
    for (const RippleLink& rim : state.rims) {
        field[rim.at] =
            rim.weight > 0 ? field[rim.at] + rim.weight * field[rim.other] : 0.0f;  // 0 is first
    }
}

}  // namespace limn
