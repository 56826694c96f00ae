#pragma once

#include "content/load/obj/obj_file.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// One step of Catmull-Clark subdivision, for meshes that were drawn as cages of smooth surfaces:
// each polygon becomes a quad per corner. On borders points follow the cubic B-spline of the
// border. After E. Catmull and J. Clark, "Recursively generated B-spline surfaces on arbitrary
// topological meshes", 1978; borders after Hoppe et al. 1994.

/// Points as weighted means of those of the cage, which hold for anything that is linear in them:
/// positions, displacements, influences of bones.
struct PointMeans {
    std::vector<std::uint32_t> first;   ///< per point and one more: index of its first below
    std::vector<std::uint32_t> points;  ///< of the cage
    std::vector<float> weights;         ///< sum 1 for each point
};

/// Subdivides the faces with a nonzero `chosen`, one per face. Points of the cage keep their
/// indices, and those of no chosen face their places. A face beside a chosen one is cut into
/// triangles with the points of the edges that they share as corners, so that no gap opens. Texture
/// coordinates are halved along edges, on both sides of a seam; normals are dropped.
[[nodiscard]] PointMeans subdivide_obj(ObjFile& obj, std::span<const char> chosen);

template <typename T>
[[nodiscard]] std::vector<T> apply_means(const PointMeans& means, std::span<const T> cage) {
    std::vector<T> values;
    values.reserve(means.first.size() - 1);
    for (std::size_t p = 0; p + 1 < means.first.size(); ++p) {
        const std::uint32_t first = means.first[p];
        T sum = means.weights[first] * cage[means.points[first]];
        for (std::uint32_t i = first + 1; i < means.first[p + 1]; ++i) {
            sum += means.weights[i] * cage[means.points[i]];
        }
        values.push_back(sum);
    }
    return values;
}

}  // namespace limn
