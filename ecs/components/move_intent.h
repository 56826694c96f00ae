#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

/// Where a character wants to go: set by a level, a player, a script or a crowd, carried out by
/// what moves its root (a generated walk, a motion graph, a body of a crowd).
struct MoveIntent {
    Vec3 velocity = Vec3(0);  ///< in the world; y counts only in water [m/s]
    Vec3 facing = Vec3(0);    ///< direction to turn to, horizontal; 0: along the velocity
    bool jump = false;        ///< leaves the ground once, as soon as it stands on it
};

LIMN_FIELDS(MoveIntent) {
    LIMN_FIELD(velocity, "wanted velocity in the world; y counts only in water", "m/s");
    LIMN_FIELD(facing, "horizontal direction to turn to; 0 0 0: along the velocity");
    LIMN_FIELD(jump, "jumps once, as soon as it stands");
}

}  // namespace limn
