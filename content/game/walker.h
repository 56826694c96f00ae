#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

namespace limn {

/// Walking character: walks on entities with a Footing, wades in shallow water and swims in deep
/// water. Its origin is between its feet, and it faces -z; a child camera is its eyes.
struct Walker {
    float speed = 2.4f;
    float eye = 1.5f;
    float radius = 0.28f;
    float step = 0.4f;
    Entity camera{};  ///< its eyes, a child; Input applies only while it is active
    float yaw = 0.0f;
};

LIMN_FIELDS(Walker) {
    LIMN_FIELD(speed, "speed on dry land", "m/s", 0, 100);
    LIMN_FIELD(eye, "eye height above the feet", "m", 0.05, 100);
    LIMN_FIELD(radius, "radius of the collision cylinder", "m", 0, 10);
    LIMN_FIELD(step, "largest step height", "m", 0, 10);
    LIMN_FIELD(camera, "child camera at its eyes, by name");
    LIMN_FIELD(yaw, "initial yaw, positive to the left", "rad");
}

/// State of a Walker.
struct WalkerState {
    float yaw = 0.0f;
    float pitch = 0.0f;
    Vec3 velocity = {0, 0, 0};
    float depth = 0.0f;
    float duck = 0.0f;
    bool grounded = false;
};

LIMN_FIELDS(WalkerState) {
    LIMN_FIELD(yaw, "yaw, positive to the left", "rad");
    LIMN_FIELD(pitch, "pitch, positive up", "rad", -1.5, 1.5);
    LIMN_FIELD(velocity, "current velocity", "m/s");
    LIMN_FIELD(depth, "depth of the water above the feet; < 0: none", "m");
    LIMN_FIELD(duck, "0 upright, 1 fully ducked under water", "", 0, 1);
    LIMN_FIELD(grounded, "on the ground");
}

/// An upright box that walkers can stand on and that blocks them.
struct Footing {
    Vec3 half = {0.5f, 0.5f, 0.5f};
    Vec3 offset = {0, 0, 0};
};

LIMN_FIELDS(Footing) {
    LIMN_FIELD(half, "half extents in local space", "m", 0, 1e4);
    LIMN_FIELD(offset, "offset of its center in local space", "m");
}

}  // namespace limn
