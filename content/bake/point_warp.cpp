#include "content/bake/point_warp.h"

#include "ecs/base/check.h"
#include "ecs/base/text.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

// Techniques: face.retarget-fit

namespace limn {

namespace {

using WarpDVec3 = glm::dvec3;

/// A square matrix by rows, with three right-hand sides.
struct LinearSystem {
    std::size_t size = 0;
    std::vector<double> matrix;  ///< element (row, column) at row * size + column
    std::vector<WarpDVec3> right;
};

/// Solves by elimination with partial pivoting; the solution replaces `right`. False where the
/// matrix is singular.
bool solve(LinearSystem& system) {
    const std::size_t n = system.size;
    const auto at = [&](std::size_t row, std::size_t column) -> double& {
        return system.matrix[row * n + column];
    };
    double scale = 0;
    for (const double value : system.matrix) {
        scale = std::max(scale, std::abs(value));
    }
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t row = k + 1; row < n; ++row) {
            pivot = std::abs(at(row, k)) > std::abs(at(pivot, k)) ? row : pivot;
        }
        if (!(std::abs(at(pivot, k)) > 1e-10 * scale)) {
            return false;
        }
        for (std::size_t column = k; column < n && pivot != k; ++column) {
            std::swap(at(k, column), at(pivot, column));
        }
        std::swap(system.right[k], system.right[pivot]);
        for (std::size_t row = k + 1; row < n; ++row) {
            const double factor = at(row, k) / at(k, k);
            for (std::size_t column = k; column < n; ++column) {
                at(row, column) -= factor * at(k, column);
            }
            system.right[row] -= factor * system.right[k];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t column = k + 1; column < n; ++column) {
            system.right[k] -= at(k, column) * system.right[column];
        }
        system.right[k] /= at(k, k);
    }
    return true;
}

}  // namespace

Result<PointWarp>
make_point_warp(std::span<const Vec3> from, std::span<const Vec3> to, WarpKernel kernel) {
    LIMN_CHECK(from.size() == to.size());
    const std::size_t count = from.size();
    if (count < 4) {
        return fail("found {} points to warp by, expected at least 4", count);
    }
    LinearSystem system;
    system.size = count + 4;
    system.matrix.assign(system.size * system.size, 0.0);
    system.right.assign(system.size, WarpDVec3(0));
    for (std::size_t i = 0; i < count; ++i) {
        system.right[i] = WarpDVec3(to[i]);
        for (std::size_t j = 0; j < count; ++j) {
            const double r = glm::distance(WarpDVec3(from[i]), WarpDVec3(from[j]));
            system.matrix[i * system.size + j] = kernel == WarpKernel::Cubic ? r * r * r : r;
        }
        for (int k = 0; k < 4; ++k) {
            const double value = k < 3 ? static_cast<double>(from[i][k]) : 1.0;
            const std::size_t column = count + static_cast<std::size_t>(k);
            system.matrix[i * system.size + column] = value;
            system.matrix[column * system.size + i] = value;
        }
    }
    if (!solve(system)) {
        return fail("found points to warp by that coincide or lie in one plane");
    }
    PointWarp warp;
    warp.kernel = kernel;
    warp.centers.assign(from.begin(), from.end());
    for (std::size_t i = 0; i < count; ++i) {
        warp.weights.emplace_back(system.right[i]);
    }
    for (int row = 0; row < 3; ++row) {
        for (int k = 0; k < 4; ++k) {
            warp.affine.row[row][k] =
                static_cast<float>(system.right[count + static_cast<std::size_t>(k)][row]);
        }
    }
    return warp;
}

Vec3 warp_point(const PointWarp& warp, const Vec3& p) {
    Vec3 moved = transform_point(warp.affine, p);
    for (std::size_t i = 0; i < warp.centers.size(); ++i) {
        const float r = glm::distance(p, warp.centers[i]);
        moved += (warp.kernel == WarpKernel::Cubic ? r * r * r : r) * warp.weights[i];
    }
    return moved;
}

}  // namespace limn
