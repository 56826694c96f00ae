#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

/// Where a character wants to go: set by a level, a player, a script or a crowd, carried out by
/// what moves its root (a generated walk, a motion graph, a body of a crowd).
struct MoveIntent {
    Vec3 velocity = Vec3(0);  ///< in the world; y is ignored on the ground [m/s]
    Vec3 facing = Vec3(0);    ///< direction to turn to, horizontal; 0: along the velocity
};

LIMN_FIELDS(MoveIntent) {
    LIMN_FIELD(velocity, "wanted velocity in the world", "m/s");
    LIMN_FIELD(facing, "horizontal direction to turn to; 0 0 0: along the velocity");
}

}  // namespace limn
