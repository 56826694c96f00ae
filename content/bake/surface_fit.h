#pragma once

#include "content/bake/point_warp.h"
#include "ecs/base/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Fits a coarse surface, such as that of the markers on one face, onto another one
// (face.retarget-fit), after J. Noh and U. Neumann, "Expression Cloning", 2001, and N. Arad et al.
// 1994: a warp of space by a few pairs of points, then energy minimization as for a surface snake,
//
//     E = strain sum |e - e'|^2 + bending sum |L - L'|^2 + distance sum |p - nearest|^2,
//
// over edge vectors e and umbrella Laplacians L of the fitted vertices p, where a prime marks the
// warped ones. For fixed nearest points on the target, E is quadratic and is minimized by conjugate
// gradients; updating the nearest points can only lower E, so it never rises. Strain compares
// vectors: rotations beyond those of the warp count as strain.

struct FitWeights {
    float strain = 0.2f;
    float bending = 0.2f;
    float distance = 1.0f;
};

struct SurfaceFit {
    std::vector<Vec3> positions;   ///< of the fitted vertices
    std::vector<double> energies;  ///< after the warp, and after each iteration [m^2]
};

/// `warped`: vertices of the surface, already warped; `target`: triangles to fit to. All indices
/// must be valid, with at least one triangle of `target`; vertices without edges snap to the
/// nearest point.
[[nodiscard]] SurfaceFit fit_surface(
    std::span<const Vec3> warped, std::span<const std::uint32_t> indices,
    std::span<const Vec3> target, std::span<const std::uint32_t> target_indices,
    const FitWeights& weights, int iterations);

/// For each of `points` the nearest of `vertices`, which has at least one.
[[nodiscard]] std::vector<std::uint32_t>
label_vertices(std::span<const Vec3> points, std::span<const Vec3> vertices);

/// The warped motion by `offset` from `rest` (face.retarget-warp), to be added to the rest position
/// of the fitted marker.
[[nodiscard]] Vec3
warp_offset(const PointWarp& warp, const Vec3& rest, const Vec3& offset, float gain = 1.0f);

}  // namespace limn
