#pragma once

#include "ecs/components/camera.h"
#include "ecs/components/mesh_levels.h"
#include "ecs/components/rendering.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"

namespace limn {

/// The level 0 .. count-1 whose quads span about `pixels_per_quad` when the one quad of level 0
/// spans `projected_pixels`. A hysteresis of 10 % about `current` avoids flicker.
[[nodiscard]] int
choose_mesh_level(float projected_pixels, int count, int current, float pixels_per_quad = 8.0f);

/// Sets MeshInstance::mesh to the level, or to none below MeshLevels::drawn_from, that suits the
/// distance to the active camera, in an image of Rendering::level_rows: what is simulated depends
/// on the world alone, not on a window.
void choose_mesh_levels(
    Query<const MeshLevels, const WorldTransform, MeshInstance> entities,
    Query<const Camera, const WorldTransform> cameras, OptionalRes<const Rendering> rendering);

}  // namespace limn
