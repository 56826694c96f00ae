#pragma once

#include "ecs/base/math.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Points and lines of a glTF file as triangles, since the renderer draws nothing else: a point is
// an octahedron, a line a three-sided prism, shaded as if round. Their radius is a fraction of the
// size of the whole, since files specify none: a distant line is thinner than a pixel.

/// Primitive modes other than triangles.
inline constexpr std::int32_t kGltfPoints = 0;
inline constexpr std::int32_t kGltfLines = 1;
inline constexpr std::int32_t kGltfLineLoop = 2;
inline constexpr std::int32_t kGltfLineStrip = 3;

/// Points or lines that are drawn of one primitive.
inline constexpr std::size_t kMaxStrokes = 200'000;

/// Vertices of the triangles, in parallel arrays.
struct Strokes {
    std::vector<std::uint32_t> sources;  ///< the vertex of the file that each belongs to
    std::vector<Vec3> offsets;           ///< from that vertex [m]
    std::vector<Vec3> normals;           ///< unit
    std::vector<std::uint32_t> indices;  ///< three per triangle
    std::size_t found = 0;               ///< points or lines, of which at most kMaxStrokes are made
};

/// The points or lines that `list` names in `positions`, evenly thinned out to kMaxStrokes. Lines
/// without length and positions that are not finite are skipped.
[[nodiscard]] Strokes make_strokes(
    std::span<const Vec3> positions, std::span<const std::uint32_t> list, std::int32_t mode);

}  // namespace limn
