#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/crowd.h"
#include "ecs/components/flock.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Moves the Boids of all flocks, each flock by itself (flock.h). Boids whose numbers are not
/// finite neither move nor are seen.
void update_flocks(
    Query<Boid, Transform, Optional<ClipPlayer>, Without<Parent>> boids,
    Query<const FlockParams> flocks, Query<const CrowdObstacle> obstacles,
    Query<const Transform> transforms, Query<const Parent> parents, Res<const Assets> assets,
    Res<const RandomSeed> seed, Res<const FrameTime> time);

}  // namespace limn
