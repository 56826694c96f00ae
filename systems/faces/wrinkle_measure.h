#pragma once

#include "ecs/components/surface.h"
#include "ecs/components/wrinkle.h"
#include "systems/faces/skin_strain.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace limn {

// How much skin is compressed across its wrinkles, from triangles to vertices to the intensity of
// the wrinkles (wrinkle.compression.*).
//
//     ratio = |x e1' + y e2'|^2,    ratio of a vertex = sum of weight * ratio
//     intensity = 2 / (1 + (lambda ratio)^beta) - 1
//
// x, y are the direction across wrinkles in the basis of the triangle's edges at rest, e1' and e2'
// the deformed edges. The ratio is the squared length of its longest chord in that direction
// relative to rest, since a triangle deforms affinely: no chord needs to be found, and only
// shortening in that direction counts, neither shortening along the wrinkles nor shear that keeps
// the chord.

/// Whether a region is in `names`, or `names` is empty.
[[nodiscard]] bool is_named(const VertexRegion& region, const std::vector<std::string>& names);

/// Where the skin of a mesh may fold, per vertex.
struct FoldField {
    std::vector<float> mask;   ///< 0 .. 1
    std::vector<Vec3> across;  ///< direction across the folds, of either sign; (0, 0, 0): none
    std::vector<float> aside;  ///< weight of the length along them, 0 .. 1/2 (equal weight)
};

/// Merges the regions with these names, or all if `names` is empty. The mask is the sum of their
/// weights, at most 1. Where they overlap, `across` is the major axis of the mean of their tensors
/// a a^T, weighted by region; a region without directions is isotropic. Without normals it is that
/// of the strongest region. `directed`: only regions that have directions.
[[nodiscard]] FoldField
merge_regions(const MeshData& mesh, const std::vector<std::string>& names, bool directed);

/// Terms besides the squared length across the folds, a:
///
///     (1 - aside) a + aside b + narrowing (1 - 2 aside) max(b - 1, 0)
///
/// with that along them, b. Skin without a direction has aside = 1/2, the mean of all directions,
/// and folds only if compressed on average. Skin that is stretched along its folds narrows without
/// folding, to its natural width in tension (Wagner 1929), by Poisson's ratio.
struct AlongFolds {
    std::span<const float> aside = {};  ///< per vertex 0 .. 1/2, see FoldField; empty: 0
    float narrowing = 0;                ///< 0 .. 1/2
};

/// `across` has a direction per vertex, of either sign; a triangle uses the mean of three,
/// projected to its plane. It has none where they cancel or are parallel to the normal, where it
/// has no area, and where a coordinate is not finite or an index is out of range. Vertices at one
/// position have the same triangles, so that UV seams do not show.
[[nodiscard]] WrinkleRest make_wrinkle_rest(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    std::span<const Vec3> across, WrinkleWeight weight = WrinkleWeight::Angle,
    const AlongFolds& along = {});

/// Measures the edges at each vertex instead of triangles: each triangle's weight is split equally
/// between its two edges there (wrinkle.compression.prior-models).
[[nodiscard]] WrinkleRest make_edge_rest(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    WrinkleWeight weight = WrinkleWeight::Angle);

/// The right Cauchy-Green tensor at each vertex, C = mean of F^T F, as squared lengths along u, v
/// and (u + v) / sqrt(2): axes `u` (unit, tangent) and v = normal x u of the vertex, rotated with
/// the normal into the plane of each triangle. `smoothing`: see WrinkleSurface; a vertex then also
/// averages tensors from farther away, in its own axes, rotated likewise.
[[nodiscard]] std::array<WrinkleRest, 3> make_strain_rest(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    std::span<const Vec3> u, std::span<const Vec3> normals,
    WrinkleWeight weight = WrinkleWeight::Angle, float smoothing = 0);

/// C from squared lengths along u, v and (u + v) / sqrt(2).
[[nodiscard]] SkinStrain tensor_of_ratios(float along_u, float along_v, float between);

/// Strain of C, sqrt(C) - I, in axes rotated by `angle` [rad] from u towards v; `side` -1 flips the
/// second axis.
[[nodiscard]] SkinStrain strain_of_tensor(const SkinStrain& tensor, float angle, float side);

/// The squared length ratio in the direction of least stretch: the lower eigenvalue of C, >= 0.
[[nodiscard]] float shortest_ratio(float along_u, float along_v, float between);

/// Squared length ratio of each triangle across its wrinkles, 1 at rest: `ratio` has one element
/// per triangle. 1 where it has no direction or a position is not finite. From `stretch_from` on,
/// the excess over 1.
void find_compression(
    const WrinkleRest& rest, std::span<const Vec3> deformed, std::span<float> ratio);

/// Weighted means of the triangles at each vertex; 1 at a vertex without any. With `mean_length` of
/// the rest they are squared means of lengths, which are below the mean of squares by the variance
/// (wrinkle.compression.square-length).
void average_compression(
    const WrinkleRest& rest, std::span<const float> ratio, std::span<float> vertices);

/// Squared length ratio at each vertex from all rests of a WrinkleState: with three in the
/// direction of least stretch, 1 without any.
[[nodiscard]] std::vector<float>
vertex_compression(std::span<const WrinkleRest> rests, std::span<const Vec3> deformed);

/// Strength of wrinkles, -1 .. 1, falling with `ratio` >= 0; negative: stretched. 0 at 1 / lambda,
/// with slope -beta lambda / 2. lambda > 1 tolerates some compression before wrinkles begin,
/// lambda < 1 shows them at rest; both > 0. After Volino and Magnenat-Thalmann
/// (wrinkle.compression.intensity).
[[nodiscard]] float wrinkle_intensity(float ratio, float lambda, float beta);

}  // namespace limn
