#pragma once

#include "ecs/base/math.h"
#include "ecs/components/wrinkle.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace limn {

// What is measured of skin, diffused over its surface (wrinkle.smoothing). A mesh cannot carry
// strain that varies faster than its edges: between two triangles it jumps, and folds would show
// the triangles. Each step moves a share of every vertex's value to the vertices around it:
//
//     x_i' = x_i + sum_j w_ij / A_i (x_j - x_i),    w_ij = s min(A_i / d_i, A_j / d_j),  s <= 2/3
//
// A: a third of the area of the triangles around, d: number of neighbors. Constant values stay as
// they are, the sum of A x is kept, no value leaves the range of the others, and how far they get
// is a number of edges: finer meshes are smoothed less. Steps that are fixed make one matrix, whose
// rows are found once; shares of less than 0.0025 stay where they are, on both sides, which keeps
// those laws. A vertex then has 54 triangles at one edge, 84 at 1.5 and 138 at two, in place of 6.
// After G. Taubin, "A signal processing approach to fair surface design", 1995.

/// The share of each vertex in the values of others, as a row per vertex.
struct SkinDiffusion {
    std::vector<std::uint32_t> first;  ///< per vertex and one more: index of its first share
    std::vector<std::pair<std::uint32_t, float>> shares;  ///< vertices and weights, sum 1 in a row
    std::vector<float> area;                              ///< A per vertex [m^2]
};

/// `edges`: root mean square of how far values go on a mesh of equal triangles, in edges, >= 0; the
/// shares that stay take a tenth of it.
/// Vertices at one position are one: rows are those of the first. `used`, a number per vertex: skin
/// that takes part; values neither enter nor leave where it is 0.
[[nodiscard]] SkinDiffusion make_skin_diffusion(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    std::span<const char> used, float edges);

/// What counts at each vertex afterwards, vertex after vertex.
struct DiffusedCorners {
    std::vector<std::uint32_t> first;   ///< per vertex and one more: index of its first in `around`
    std::vector<WrinkleCorner> around;  ///< corner / `group` of the rest, each once, in their order
};

/// By the corners of all vertices that have a share in it. Those with the same corner / `group`
/// become one.
[[nodiscard]] DiffusedCorners
diffuse_corners(const SkinDiffusion& diffusion, const WrinkleRest& rest, std::uint32_t group);

/// Measures as if the values at the vertices were diffused afterwards.
void diffuse_rest(
    WrinkleRest& rest, std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    float edges);

}  // namespace limn
