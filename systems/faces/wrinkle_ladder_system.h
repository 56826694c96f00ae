#pragma once

#include "ecs/commands.h"
#include "ecs/components/camera.h"
#include "ecs/components/rendering.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/components/wrinkle_ladder.h"
#include "ecs/query.h"
#include "ecs/schedule.h"

namespace limn {

/// Adds the WrinkleRungs of each WrinkleLadder.
void add_wrinkle_rungs(Query<const WrinkleLadder, Without<WrinkleRungs>> faces, Commands commands);

/// Sets WrinkleRungs by the height of meshes in the view of the active camera; all to 0 for an
/// entity without a mesh, and to 1 without a camera.
void climb_wrinkle_ladders(
    Query<const WrinkleLadder, const MeshInstance, const WorldTransform, WrinkleRungs> faces,
    Query<const Camera, const WorldTransform> cameras, Res<const Assets> assets,
    OptionalRes<const Rendering> rendering);

/// The rungs of a face that is `height` pixels high.
[[nodiscard]] WrinkleRungs wrinkle_rungs(const WrinkleLadder& ladder, float height);

}  // namespace limn
