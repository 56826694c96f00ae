#pragma once

#include "ecs/commands.h"
#include "ecs/components/camera.h"
#include "ecs/components/relief_box.h"
#include "ecs/components/rendering.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"

#include <cstdint>

namespace limn {

// What is drawn of relief boxes (relief_box.h): the meshes of their sides, and stacks of planes for
// the sides that face the camera. render/shaders/lib/relief_box.glsl explains the programs.
// Reads ReliefBox, Camera; writes ReliefBoxState, and appends to Assets.

void add_relief_box_states(
    Query<const ReliefBox, Without<ReliefBoxState>> boxes, Commands commands);

/// After everything that moves cameras.
void update_relief_boxes(
    Query<const ReliefBox, const WorldTransform, ReliefBoxState> boxes,
    Query<const Camera, const WorldTransform> cameras, OptionalRes<const Rendering> rendering,
    Res<Assets> assets);

// ---- parts of the above ----

/// A bit per ReliefFace of a box about the origin: the sides that face `eye`. At most three; none
/// within the box.
[[nodiscard]] std::uint32_t facing_sides(const Vec3& eye, const Vec3& half_size);

/// The smallest power of two that is at least `pixels`, the depth of a relief in the image over the
/// distance wanted, within limits that need not be powers. A hysteresis of 20 % about `current`
/// avoids flicker; 0: none yet.
[[nodiscard]] int choose_slice_count(float pixels, int current, int least, int most);

/// The sides (bits) of a unit box in the coordinates of the map of one of them.
[[nodiscard]] MeshData make_box_sides(ReliefFace map, std::uint32_t sides);
/// `count` planes at depths of k / count from the map's side, k = count .. 1: the deepest first.
[[nodiscard]] MeshData make_face_slices(ReliefFace map, int count);
/// `count` planes with this normal (not 0) at equal distances through the whole box, deepest first,
/// cut to the box: polygons of 3 to 6 corners.
[[nodiscard]] MeshData make_view_slices(ReliefFace map, const Vec3& normal, int count);

}  // namespace limn
