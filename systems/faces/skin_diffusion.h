#pragma once

#include "ecs/base/math.h"
#include "ecs/components/wrinkle.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace limn {

// Diffusion of measured compression over the skin (wrinkle.smoothing). A mesh cannot represent
// strain that varies faster than its edges: it jumps between two triangles, and folds would show
// the triangles. Each step moves a fraction of every vertex's value to its neighbors:
//
//     x_i' = x_i + sum_j w_ij / A_i (x_j - x_i),    w_ij = s min(A_i / d_i, A_j / d_j),  s <= 2/3
//
// A: a third of the area of the adjacent triangles, d: number of neighbors. Constant values are
// preserved, so is the sum of A x, no value leaves the range of the others, and the distance is a
// number of edges: finer meshes are smoothed less. A fixed number of steps is one sparse matrix,
// whose rows are computed once; weights below 0.0025 are dropped on both sides, which keeps those
// laws. A vertex then has 54 triangles at one edge, 84 at 1.5 and 138 at two, instead of 6.
// After G. Taubin, "A signal processing approach to fair surface design", 1995.

/// The weight of each vertex in the values of others: a sparse matrix with a row per vertex.
struct SkinDiffusion {
    std::vector<std::uint32_t> first;  ///< offsets into `weights`, one per vertex plus the end
    std::vector<std::pair<std::uint32_t, float>> weights;  ///< vertices and weights, sum 1 in a row
    std::vector<float> area;                               ///< A per vertex [m^2]
};

/// `edges`: RMS diffusion distance on a mesh of equal triangles, in edge lengths, >= 0; dropping
/// small weights shortens it by a tenth.
/// Vertices at one position count as one and have the row of the first. `used`, a flag per vertex:
/// skin that takes part; values neither enter nor leave where it is 0.
[[nodiscard]] SkinDiffusion make_skin_diffusion(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    std::span<const char> used, float edges);

/// The weighted corners of each vertex after diffusion, vertex by vertex.
struct DiffusedCorners {
    std::vector<std::uint32_t> first;   ///< offsets into `around`, one per vertex plus the end
    std::vector<WrinkleCorner> around;  ///< corner / `group` of the rest, each once, sorted
};

/// Each vertex gets the corners of all vertices with a weight in its row. Those with the same
/// corner / `group` are merged.
[[nodiscard]] DiffusedCorners
diffuse_corners(const SkinDiffusion& diffusion, const WrinkleRest& rest, std::uint32_t group);

/// Changes `rest` to measure as if the values at the vertices were diffused afterwards.
void diffuse_rest(
    WrinkleRest& rest, std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    float edges);

}  // namespace limn
