#pragma once

#include "ecs/commands.h"
#include "ecs/components/height_field.h"
#include "ecs/components/shoaling_waves.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Adds state and heights to new ShoalingWaves.
void add_shoaling_states(
    Query<const ShoalingWaves, Without<ShoalingState>> bare, Commands commands);

/// Fills the heights for the time at the end of the step; first refracts waves that are new or
/// changed.
void update_shoaling_waves(
    Query<const ShoalingWaves, ShoalingState, HeightField> waters, Res<const FrameTime> time);

/// Moves the vertices of meshes to the heights of their entities. A mesh is shared by all entities
/// that show it.
void shape_height_meshes(Query<const HeightField, const MeshInstance> surfaces, Res<Assets> assets);

}  // namespace limn
