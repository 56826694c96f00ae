#pragma once

#include "ecs/reflect.h"

namespace limn {

// Techniques: engine.explosion

/// The entity is destroyed with its descendants when its time is up: effects that are spawned and
/// not thought of again.
struct Lifetime {
    float left = 5;
};

LIMN_FIELDS(Lifetime) {
    LIMN_FIELD(left, "until it is destroyed, with its children", "s", 0, 1e6);
}

}  // namespace limn
