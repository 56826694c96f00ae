#pragma once

#include "content/bake/marker_motion.h"
#include "content/load/gltf/gltf_scene.h"
#include "ecs/base/result.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Recorded markers on another face (face.retarget-fit, face.retarget-warp). Each marker has a place
// on it; a warp of space through these pairs of points, with r^3, maps the motion, and with it the
// size of the face. The face's own shapes are then weighted so that they follow the markers.

/// A line of a map.
struct FaceMarkerPlace {
    std::string marker;
    std::string place;     ///< a name, if it has no point
    Vec3 point = Vec3(0);  ///< in the space of the face's mesh [m]
    std::size_t line = 0;
};

/// Lines "marker = x y z" [m] or "marker = place", where a place is a marker of the built-in head,
/// "mouth9_90_M", or one of place_names(); # begins a comment. Fails with "file:line: found X,
/// expected Y".
[[nodiscard]] Result<std::vector<FaceMarkerPlace>>
parse_marker_map(std::string_view text, const std::string& file);

/// The map `text` with these places in it: comments and lines that say the same stay as they are,
/// lines of other markers go, and new ones follow.
[[nodiscard]] std::string
write_marker_map(std::string_view text, std::span<const FaceMarkerPlace> places);

/// The point of the skin at rest that has this name, as the right side of a map; none if the name
/// is unknown or the mesh lacks the texture coordinates of the built-in head there.
[[nodiscard]] std::optional<Vec3> find_named_place(const MeshData& skin, std::string_view name);

/// Fails with one line that lists markers of the map which are not among `markers`, each with the
/// nearest name. `file`: of the map, for messages.
[[nodiscard]] Status check_marker_map(
    std::span<const std::string> markers, std::span<const FaceMarkerPlace> map,
    const std::string& file);

/// Places that many sets of markers have, as "chin" or "browinner", of which some have a left and a
/// right side. In names of markers their case and "_", "-", "." and blanks do not count, and the
/// side may be "left", "right", "l" or "r", before or after.
[[nodiscard]] std::vector<std::string_view> place_names();

/// Places of markers on a face, and what its shapes do there.
struct FaceMarkers {
    std::vector<Vec3> points;              ///< at rest [m]
    std::vector<std::string> shapes;       ///< names
    std::vector<std::vector<Vec3>> moves;  ///< of the points, for each of the shapes at weight 1
    std::vector<float> costs;              ///< of the square weight of each shape [m^2]
};

/// Places come from `map`, else from the names of the markers. Named ones need a face with the
/// texture coordinates of the built-in head: one that `limn import` or `limn make head` wrote. They
/// are at the nearest vertex of the skin, points of a map at its nearest point. Fails with one line
/// that lists wrong names and markers without a place, each with the nearest name. `file`: of the
/// map, for messages.
[[nodiscard]] Result<FaceMarkers> place_markers(
    const GltfScene& face, std::span<const std::string> markers,
    std::span<const FaceMarkerPlace> map, const std::string& file);

/// The motion, whose first frame is at rest, moved onto `points`, one per marker. Where these pairs
/// determine no warp, as fewer than four or all in a plane, offsets are scaled by the ratio of the
/// sizes of the faces.
[[nodiscard]] MarkerMotion
retarget_markers(const MarkerMotion& motion, std::span<const Vec3> points, float gain = 1.0f);

/// Weights of 0 .. 1, one per shape, for which the points move by `offsets` as closely as they can
/// (coordinate descent from 0). Weights have a cost, so that many shapes of small motion do not add
/// up to a grimace: relative to the largest shape that moves the same markers, so that brows, which
/// move less than a jaw, follow as far as it.
void fit_shape_weights(
    const FaceMarkers& face, std::span<const Vec3> offsets, std::span<float> weights);

/// The weights in each frame of a retargeted motion.
[[nodiscard]] std::vector<std::vector<float>>
drive_shapes(const FaceMarkers& face, const MarkerMotion& motion);

}  // namespace limn
