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
// x, y are the direction across wrinkles in the edges of the triangle at rest, e1' and e2' the
// edges now. That is the square of its longest chord in that direction by what it was at rest,
// since a triangle deforms affinely: no chord needs to be found, and only shortening in that
// direction counts, neither shortening along the wrinkles nor shear that keeps the chord.

/// Whether a region is one of these, or there are no names.
[[nodiscard]] bool is_named(const VertexRegion& region, const std::vector<std::string>& names);

/// Where the skin of a mesh may fold, per vertex.
struct FoldField {
    std::vector<float> mask;   ///< 0 .. 1
    std::vector<Vec3> across;  ///< direction across the folds, of either sign; (0, 0, 0): none
    std::vector<float> aside;  ///< how much the length along them counts, 0 .. 1/2: as much
};

/// Of the regions with these names, or all if there are none: the sum of their weights, at most 1.
/// Where they overlap, each direction counts by the weight of its region, and a region without
/// directions alike in all of them: `across` is the axis of the mean of their tensors a a^T.
/// Without normals it is that of the strongest. `directed`: only regions that have directions.
[[nodiscard]] FoldField
merge_regions(const MeshData& mesh, const std::vector<std::string>& names, bool directed);

/// What counts besides the square of the length across the folds, a:
///
///     (1 - aside) a + aside b + narrowing (1 - 2 aside) max(b - 1, 0)
///
/// with that along them, b. Skin without a direction has aside = 1/2, the mean of all directions,
/// and folds only where it is compressed on balance. Skin that is stretched along its folds gets
/// narrower by itself, its natural width in tension (Wagner 1929), as far as Poisson's ratio says.
struct AlongFolds {
    std::span<const float> aside = {};  ///< per vertex 0 .. 1/2, see FoldField; empty: 0
    float narrowing = 0;                ///< 0 .. 1/2
};

/// `across` has a direction per vertex, of either sign: the mean of three is used, without its part
/// along the normal. A triangle has none where they cancel or are parallel to the normal, where it
/// has no area, and where a coordinate is not finite or an index beyond the positions. Vertices at
/// one position have the same triangles, so that UV seams do not show.
[[nodiscard]] WrinkleRest make_wrinkle_rest(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    std::span<const Vec3> across, WrinkleWeight weight = WrinkleWeight::Angle,
    const AlongFolds& along = {});

/// Edges from each vertex, instead of triangles: of each triangle's share half goes to each of its
/// two edges there (wrinkle.compression.prior-models).
[[nodiscard]] WrinkleRest make_edge_rest(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    WrinkleWeight weight = WrinkleWeight::Angle);

/// The right Cauchy-Green tensor at each vertex, C = mean of F^T F, as the squares of lengths along
/// u, v and (u + v) / sqrt(2): axes `u` (unit, tangent) and v = normal x u of the vertex, turned
/// into the plane of each triangle with the normal. `smoothing`: see WrinkleSurface; tensors then
/// come to a vertex from farther away, each in the axes of the vertex, turned so.
[[nodiscard]] std::array<WrinkleRest, 3> make_strain_rest(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    std::span<const Vec3> u, std::span<const Vec3> normals,
    WrinkleWeight weight = WrinkleWeight::Angle, float smoothing = 0);

/// C of lengths along u, v and (u + v) / sqrt(2), squared.
[[nodiscard]] SkinStrain tensor_of_ratios(float along_u, float along_v, float between);

/// Strain of C, sqrt(C) - I, in axes turned by `angle` [rad] from u towards v; with `side` -1 the
/// second one is opposite.
[[nodiscard]] SkinStrain strain_of_tensor(const SkinStrain& tensor, float angle, float side);

/// The square of the length in the shortest direction: the lower eigenvalue of C, >= 0.
[[nodiscard]] float shortest_ratio(float along_u, float along_v, float between);

/// Square of the length of each triangle across its wrinkles, 1 at rest: `ratio` has one element
/// per triangle. 1 where it has no direction or a position is not finite. From `stretch_from` on,
/// what it is above 1.
void find_compression(
    const WrinkleRest& rest, std::span<const Vec3> deformed, std::span<float> ratio);

/// Weighted means of the triangles at each vertex; 1 at a vertex without any. With `mean_length` of
/// the rest they are of lengths, squared: less than the mean of squares by their variance
/// (wrinkle.compression.square-length).
void average_compression(
    const WrinkleRest& rest, std::span<const float> ratio, std::span<float> vertices);

/// Square of the length at each vertex by all rests of a WrinkleState: in the shortest direction of
/// three, 1 without any.
[[nodiscard]] std::vector<float>
vertex_compression(std::span<const WrinkleRest> rests, std::span<const Vec3> deformed);

/// How strong wrinkles are, -1 .. 1, falling with `ratio` >= 0; negative: stretched. 0 at 1 /
/// lambda; the slope there is -beta lambda / 2. lambda > 1 lets some compression pass before
/// wrinkles begin, lambda < 1 shows them at rest; both > 0. After Volino and Magnenat-Thalmann
/// (wrinkle.compression.intensity).
[[nodiscard]] float wrinkle_intensity(float ratio, float lambda, float beta);

}  // namespace limn
