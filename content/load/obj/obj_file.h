#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Reads untrusted Wavefront OBJ files: vertices with colors, texture coordinates, normals,
// polygons, lines and points, and the names of their objects, groups and materials. Positive
// indices may refer to vertices further down. A bad line costs what it says and leaves one line of
// text: "head.obj:12: found X, expected Y; the face is left out". A face loses its texture
// coordinates or normals where one of those is bad. Maps and scans stand millions of meters from
// their origin, where floats have steps of half a meter: there, positions are relative to the first
// one. Ignored with a warning: free-form surfaces. Smoothing groups are ignored.
// After Wavefront Technologies, "Object Files", Advanced Visualizer Manual, appendix B1, 1995, and
// for colors P. Bourke, "OBJ with vertex colours".

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

/// Points, or lines with two indices each, into the positions of an ObjFile.
struct ObjStrokes {
    std::vector<std::uint32_t> indices;
    std::uint32_t material = 0;  ///< index into `materials`, of the first one
};

struct ObjFile {
    Vec3 origin = {0, 0, 0};      ///< of `positions` in the file
    std::vector<Vec3> positions;  ///< in the file's unit; (0, 0, 0) for a bad one, without faces
    std::vector<Vec3> colors;     ///< one for each position, linear RGB 0 .. 1, or empty
    std::vector<Vec2> uvs;        ///< (0, 0) is the bottom left of the image
    std::vector<Vec3> normals;    ///< as in the file, any length; (0, 0, 0): bad, or none
    std::vector<ObjCorner> corners;
    std::vector<ObjFace> faces;
    ObjStrokes points;
    ObjStrokes lines;
    std::vector<std::string> objects = {""};    ///< [0] for faces before the first `o`
    std::vector<std::string> groups = {""};     ///< likewise; of several, joined by a space
    std::vector<std::string> materials = {""};  ///< likewise
    std::vector<std::string>
        libraries;                      ///< of materials: the rest of each `mtllib`, as in the file
    std::vector<std::string> errors;    ///< one line per bad part that is left out
    std::vector<std::string> warnings;  ///< one line per ignored feature
};

/// Limits on untrusted files.
struct ObjLimits {
    std::uint64_t max_bytes = std::uint64_t{1} << 30;
    std::size_t max_vertices = std::size_t{1} << 25;    ///< of each kind
    std::size_t max_corners = std::size_t{1} << 27;     ///< of all polygons
    std::size_t max_names = std::size_t{1} << 16;       ///< of each kind
    std::uint64_t max_pixels = std::uint64_t{1} << 28;  ///< of all images together
};

/// Fails where a limit is exceeded.
[[nodiscard]] Result<ObjFile>
parse_obj(std::string_view text, const std::string& file, const ObjLimits& limits = {});

/// The same from a file.
[[nodiscard]] Result<ObjFile> load_obj(const std::string& path, const ObjLimits& limits = {});

/// The same for importers that need every vertex: fails where a part is bad.
[[nodiscard]] Result<ObjFile> load_intact_obj(const std::string& path);

}  // namespace limn
