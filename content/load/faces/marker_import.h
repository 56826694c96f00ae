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
// a joint that a clip moves, and a vertex of an invisible surface. A mesh that is bound to it by
// patches (surface_binding) performs the recording (face.mocap-drive).

/// Three markers per triangle, counter-clockwise from outside, of a face that looks along +z: the
/// Delaunay triangulation of the markers unrolled around a vertical axis behind them (A. Bowyer, D.
/// Watson 1981). Empty if fewer than three are distinct.
[[nodiscard]] std::vector<std::uint32_t> triangulate_markers(std::span<const Vec3> positions);

/// A surface whose markers are known.
struct MarkerSurface {
    MeshData mesh;
    std::vector<std::string> names;  ///< of its vertices; equal on both sides of a seam
};

/// The marker surface of the generated head (head_markers.h).
[[nodiscard]] MarkerSurface make_head_marker_surface();

/// The motion of the face without that of the head, and without gaps; markers of the head are left
/// out. The first frame is the face at rest. Fails as make_marker_scene does.
[[nodiscard]] Result<MarkerMotion> isolate_face(const std::string& name, MarkerMotion motion);

/// The first frame is the face at rest, +y up. Markers whose names begin with "head" serve to
/// remove the head's motion; they are not part of the surface. Fails with one line when the first
/// frame lacks a marker, the head's markers do not determine its pose, or fewer than three others
/// remain.
[[nodiscard]] Result<GltfScene> make_marker_scene(const std::string& name, MarkerMotion motion);

/// The same for a known surface in its rest pose: each of its markers moves by the offset of the
/// recorded marker of its name from the first frame; those not recorded follow their neighbors.
/// Also fails with one line on a name that the surface lacks.
[[nodiscard]] Result<GltfScene>
make_marker_scene(const std::string& name, MarkerMotion motion, const MarkerSurface& surface);

/// The scene of the TRC file `in`; `surface` may be null.
[[nodiscard]] Result<GltfScene>
import_markers(const std::string& in, const MarkerSurface* surface = nullptr);

}  // namespace limn
