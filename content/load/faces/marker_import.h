#pragma once

#include "content/bake/marker_motion.h"
#include "content/load/gltf/gltf_scene.h"
#include "ecs/base/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace limn {

// Recorded markers of a face as a character whose skin is the surface through them: each marker is
// a joint that a clip moves, and a vertex of a surface that nothing is seen of. A mesh that is
// bound to it by patches (surface_binding) performs the recording (face.mocap-drive).

/// Three markers per triangle, counter-clockwise seen from outside, of a face that looks along +z:
/// the Delaunay triangulation of the markers around a vertical axis behind them (A. Bowyer, D.
/// Watson 1981). Empty where fewer than three are at different places.
[[nodiscard]] std::vector<std::uint32_t> triangulate_markers(std::span<const Vec3> positions);

/// A surface whose markers are known.
struct MarkerSurface {
    MeshData mesh;
    std::vector<std::string> names;  ///< of its vertices; those on both sides of a seam are one
};

/// That of the project's own head (head_markers.h).
[[nodiscard]] MarkerSurface make_head_marker_surface();

/// The first frame is the face at rest, +y up. Markers whose names begin with "head" take the
/// head's motion out; they are no part of the surface. Fails with one line when the first frame
/// lacks a marker, the head's markers do not determine its place, or fewer than three are left.
[[nodiscard]] Result<GltfScene> make_marker_scene(const std::string& name, MarkerMotion motion);

/// The same for a known surface, in the rest pose of that: each of its markers moves as far from
/// there as the one of its name from the first frame; those that were not recorded go with their
/// neighbors. Fails with one line at a name that the surface lacks as well.
[[nodiscard]] Result<GltfScene>
make_marker_scene(const std::string& name, MarkerMotion motion, const MarkerSurface& surface);

/// The file `in`, TRC, as such a scene; `surface` may be null.
[[nodiscard]] Result<GltfScene>
import_markers(const std::string& in, const MarkerSurface* surface = nullptr);

}  // namespace limn
