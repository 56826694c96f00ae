#pragma once

#include "ecs/components/environment.h"
#include "ecs/components/light.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Gives every Sunlight's directional light what the air lets through to the ground from its
/// direction: all of it unless the sky is an atmosphere, nothing from below the horizon.
/// After everything that moves lights.
void update_sunlight(
    Query<const Sunlight, const WorldTransform, DirectionalLight> suns,
    OptionalRes<const Environment> environment);

}  // namespace limn
