#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Reads untrusted Wavefront OBJ files: vertices, texture coordinates, normals, polygons, and the
// names of their objects, groups and materials. Every index is checked where it stands, and an
// error is one line: "head.obj:12: found X, expected Y". Ignored with a warning: points, lines and
// free-form surfaces. Smoothing groups are ignored.
// After Wavefront Technologies, "Object Files", Advanced Visualizer Manual, appendix B1, 1995.

/// Indices into the lists of an ObjFile; -1: none.
struct ObjCorner {
    std::uint32_t position = 0;
    std::int32_t uv = -1;
    std::int32_t normal = -1;
};

/// A polygon of at least three corners, counter-clockwise seen from the front.
struct ObjFace {
    std::uint32_t first = 0;     ///< of its corners
    std::uint32_t count = 0;     ///< of its corners, >= 3
    std::uint32_t object = 0;    ///< index into `objects`
    std::uint32_t group = 0;     ///< index into `groups`
    std::uint32_t material = 0;  ///< index into `materials`
};

struct ObjFile {
    std::vector<Vec3> positions;  ///< in the file's unit
    std::vector<Vec2> uvs;        ///< (0, 0) is the bottom left of the image
    std::vector<Vec3> normals;    ///< as in the file, any length
    std::vector<ObjCorner> corners;
    std::vector<ObjFace> faces;
    std::vector<std::string> objects = {""};    ///< [0] for faces before the first `o`
    std::vector<std::string> groups = {""};     ///< likewise; of several, joined by a space
    std::vector<std::string> materials = {""};  ///< likewise
    std::vector<std::string> libraries;         ///< of materials, as in the file
    std::vector<std::string> warnings;          ///< one line per ignored feature
};

/// Colors of a material library, of which these are read.
struct ObjMaterial {
    std::string name;
    Vec3 diffuse = {0.8f, 0.8f, 0.8f};  ///< Kd, linear RGB, 0 .. 1
    Vec3 emission = {0, 0, 0};          ///< Ke, linear RGB, >= 0
    float shininess = 0.0f;             ///< Ns, 0 .. 1000
    float opacity = 1.0f;               ///< d, or 1 - Tr, 0 .. 1
};

/// Limits on untrusted files.
struct ObjLimits {
    std::uint64_t max_bytes = std::uint64_t{1} << 30;
    std::size_t max_vertices = std::size_t{1} << 25;  ///< of each kind
    std::size_t max_corners = std::size_t{1} << 27;   ///< of all polygons
    std::size_t max_names = std::size_t{1} << 16;     ///< of each kind
};

[[nodiscard]] Result<ObjFile>
parse_obj(std::string_view text, const std::string& file, const ObjLimits& limits = {});

/// The same from a file.
[[nodiscard]] Result<ObjFile> load_obj(const std::string& path, const ObjLimits& limits = {});

/// The materials of a library (.mtl), in its order. Statements that are not read are ignored; a
/// value that is no number or out of range is an error.
[[nodiscard]] Result<std::vector<ObjMaterial>>
parse_obj_materials(std::string_view text, const std::string& file, const ObjLimits& limits = {});

/// Corner numbers, 0 .. count - 1, three per triangle, of a polygon with these corners. Quads are
/// split along the diagonal from their first corner unless it lies outside; larger polygons by
/// cutting ears (Meisters 1975), and as a fan above 64 corners.
[[nodiscard]] std::vector<std::uint32_t> triangulate_polygon(std::span<const Vec3> corners);

}  // namespace limn
