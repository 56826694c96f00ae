#include "systems/particles/mesh_volume.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

// Techniques: particle.mesh-volume
// Source of particle.mesh-volume: births in the volume of a mesh, as in most effect tools; point in
//     polyhedron by crossings along a column

namespace limn {
namespace {

constexpr int kMaxSide = 64;
constexpr std::size_t kMaxCellsPerTriangle = 8;  // on average
constexpr int kTries = 64;

using Triangle = std::array<Vec3, 3>;

/// False if an index is beyond the positions, or a corner is not finite.
bool find_triangle(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices, std::size_t i,
    Triangle& corners) {
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = indices[3 * i + k];
        if (vertex >= positions.size() || !is_finite(positions[vertex])) {
            return false;
        }
        corners[k] = positions[vertex];
    }
    return true;
}

struct Box {
    Vec3 low = Vec3(std::numeric_limits<float>::infinity());
    Vec3 high = Vec3(-std::numeric_limits<float>::infinity());
    void add(const Vec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
};

Box box_of(const Triangle& corners) {
    Box box;
    for (const Vec3& p : corners) {
        box.add(p);
    }
    return box;
}

int cell_of(float coordinate, float low, float cell, int side) {
    const float at = cell > 0 ? (coordinate - low) / cell : 0;
    return static_cast<int>(std::clamp(at, 0.0f, static_cast<float>(side - 1)));
}

/// Calls `visit` with the number of each cell that the box is over.
template <typename Visit>
void for_cells(const MeshVolume& grid, const Box& box, Visit&& visit) {
    const int x0 = cell_of(box.low.x, grid.low.x, grid.cell.x, grid.side);
    const int x1 = cell_of(box.high.x, grid.low.x, grid.cell.x, grid.side);
    const int z0 = cell_of(box.low.z, grid.low.z, grid.cell.y, grid.side);
    const int z1 = cell_of(box.high.z, grid.low.z, grid.cell.y, grid.side);
    for (int z = z0; z <= z1; ++z) {
        for (int x = x0; x <= x1; ++x) {
            visit(static_cast<std::size_t>(z * grid.side + x));
        }
    }
}

/// Calls `visit` with the number and the box of each triangle.
template <typename Visit>
void for_triangles(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices, Visit&& visit) {
    Triangle corners{};
    for (std::size_t i = 0; i < indices.size() / 3; ++i) {
        if (find_triangle(positions, indices, i, corners)) {
            visit(static_cast<std::uint32_t>(i), box_of(corners));
        }
    }
}

/// Chooses the finest grid, of at most one cell per two triangles, in which a triangle is not over
/// too many cells, and counts the triangles of each cell.
void choose_cells(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices, const Box& bounds,
    MeshVolume& volume) {
    const std::size_t count = indices.size() / 3;
    const double wished = std::sqrt(0.5 * static_cast<double>(count));
    volume.side = static_cast<int>(std::clamp(wished, 1.0, static_cast<double>(kMaxSide)));
    volume.low = bounds.low;
    const Vec3 size = bounds.high - bounds.low;
    for (;; volume.side = std::max(volume.side / 2, 1)) {
        volume.cell = Vec2(size.x, size.z) / static_cast<float>(volume.side);
        const auto cells = static_cast<std::size_t>(volume.side * volume.side);
        volume.first.assign(cells + 1, 0);
        std::size_t all = 0;
        for_triangles(positions, indices, [&](std::uint32_t, const Box& box) {
            for_cells(volume, box, [&](std::size_t cell) {
                ++volume.first[cell + 1];
                ++all;
            });
        });
        if (volume.side == 1 || all <= kMaxCellsPerTriangle * count) {
            volume.triangles.resize(all);
            break;
        }
    }
    for (std::size_t i = 1; i < volume.first.size(); ++i) {
        volume.first[i] += volume.first[i - 1];
    }
}

/// Winding number of the triangle's projection around x, z: -1, 0 or 1.
int turns_around(const Triangle& corners, double x, double z) {
    int turns = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& from = corners[k];
        const Vec3& to = corners[(k + 1) % 3];
        const bool rises = static_cast<double>(to.z) > z;
        if ((static_cast<double>(from.z) > z) == rises) {
            continue;
        }
        // Always from the end of smaller z: both triangles of an edge get the same result.
        const glm::dvec3 a(rises ? from : to);
        const glm::dvec3 b(rises ? to : from);
        if (x < a.x + (z - a.z) / (b.z - a.z) * (b.x - a.x)) {
            turns += rises ? 1 : -1;
        }
    }
    return turns;
}

/// Height of the triangle's plane at x, z.
double height_at(const Triangle& corners, double x, double z) {
    const glm::dvec3 a(corners[0]);
    const glm::dvec3 u = glm::dvec3(corners[1]) - a;
    const glm::dvec3 v = glm::dvec3(corners[2]) - a;
    const double area = u.x * v.z - u.z * v.x;
    const double su = ((x - a.x) * v.z - (z - a.z) * v.x) / area;
    const double sv = (u.x * (z - a.z) - u.z * (x - a.x)) / area;
    return area == 0 ? a.y : a.y + su * u.y + sv * v.y;
}

bool is_inside(
    const MeshVolume& volume, std::span<const Vec3> positions,
    std::span<const std::uint32_t> indices, std::size_t cell, const Vec3& point) {
    int above = 0;
    int all = 0;
    Triangle corners{};
    const double x = static_cast<double>(point.x);
    const double z = static_cast<double>(point.z);
    for (std::uint32_t i = volume.first[cell]; i < volume.first[cell + 1]; ++i) {
        if (!find_triangle(positions, indices, volume.triangles[i], corners)) {
            continue;
        }
        const int turns = turns_around(corners, x, z);
        if (turns != 0) {
            all += turns;
            above += height_at(corners, x, z) > static_cast<double>(point.y) ? turns : 0;
        }
    }
    return all == 0 && above != 0;
}

}  // namespace

bool fill_mesh_volume(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices, MeshVolume& volume) {
    Box bounds;
    for_triangles(positions, indices, [&](std::uint32_t, const Box& box) {
        bounds.add(box.low);
        bounds.add(box.high);
    });
    if (!is_finite(bounds.high - bounds.low)) {
        return false;
    }
    choose_cells(positions, indices, bounds, volume);
    const std::size_t cells = volume.first.size() - 1;
    const auto infinity = std::numeric_limits<float>::infinity();
    volume.heights.assign(cells, {infinity, -infinity});
    std::vector<std::uint32_t>& next = volume.first;  // moves to the end of its cell
    for_triangles(positions, indices, [&](std::uint32_t i, const Box& box) {
        for_cells(volume, box, [&](std::size_t cell) {
            volume.triangles[next[cell]++] = i;
            Vec2& height = volume.heights[cell];
            height = {std::min(height.x, box.low.y), std::max(height.y, box.high.y)};
        });
    });
    for (std::size_t i = cells; i > 0; --i) {
        next[i] = next[i - 1];
    }
    next[0] = 0;
    volume.sums.resize(cells);
    const double area = static_cast<double>(volume.cell.x) * static_cast<double>(volume.cell.y);
    double sum = 0;
    for (std::size_t i = 0; i < cells; ++i) {
        const Vec2 height = volume.heights[i];
        sum += height.y > height.x ? area * static_cast<double>(height.y - height.x) : 0.0;
        volume.sums[i] = sum;
    }
    return sum > 0 && std::isfinite(sum);
}

bool is_in_volume(
    const MeshVolume& volume, std::span<const Vec3> positions,
    std::span<const std::uint32_t> indices, const Vec3& point) {
    const int x = cell_of(point.x, volume.low.x, volume.cell.x, volume.side);
    const int z = cell_of(point.z, volume.low.z, volume.cell.y, volume.side);
    const auto cell = static_cast<std::size_t>(z * volume.side + x);
    return is_inside(volume, positions, indices, cell, point);
}

std::optional<Vec3> draw_in_volume(
    const MeshVolume& volume, std::span<const Vec3> positions,
    std::span<const std::uint32_t> indices, Random& random) {
    for (int i = 0; i < kTries; ++i) {
        const double wanted = volume.sums.back() * static_cast<double>(random.uniform());
        const auto found = std::upper_bound(volume.sums.begin(), volume.sums.end(), wanted);
        const auto last = static_cast<std::ptrdiff_t>(volume.sums.size()) - 1;
        const auto cell = static_cast<std::size_t>(std::min(found - volume.sums.begin(), last));
        const std::size_t side = static_cast<std::size_t>(volume.side);
        const float u = static_cast<float>(cell % side) + random.uniform();
        const float v = static_cast<float>(cell / side) + random.uniform();
        const Vec2 height = volume.heights[cell];
        const Vec3 point = {
            volume.low.x + u * volume.cell.x, glm::mix(height.x, height.y, random.uniform()),
            volume.low.z + v * volume.cell.y};
        // In the cell of its coordinates, which rounding may have moved to the next one.
        if (is_in_volume(volume, positions, indices, point)) {
            return point;
        }
    }
    return std::nullopt;
}

}  // namespace limn
