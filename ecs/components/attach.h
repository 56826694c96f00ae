#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <string>
#include <vector>

namespace limn {

/// A frame of an object where others are attached, or by which it is: a hook, a grip, a coupling.
struct AttachPoint {
    std::string name;
    Vec3 position = {0, 0, 0};
    Quat rotation = {1, 0, 0, 0};
};

LIMN_FIELDS(AttachPoint) {
    LIMN_FIELD(name, "unique among the points of the object");
    LIMN_FIELD(position, "in the space of the object", "m");
    LIMN_FIELD(rotation, "unit quaternion x y z w, or Euler angles [yaw, pitch, roll] in degrees");
}

struct AttachPoints {
    std::vector<AttachPoint> points;
};

LIMN_FIELDS(AttachPoints) {
    LIMN_FIELD(points, "frames by which objects are attached to each other");
}

/// Attaches its entity to another one, so that a point of each coincides: as its child, from the
/// first step on and after each change (engine.attach).
struct Attach {
    Entity to{};
    std::string at;
    std::string by;
    bool facing = false;

    bool operator==(const Attach&) const = default;
};

LIMN_FIELDS(Attach) {
    LIMN_FIELD(to, "entity that it becomes a child of; none: it is detached");
    LIMN_FIELD(at, "attach point of that entity; empty: its origin");
    LIMN_FIELD(by, "attach point of this entity; empty: its origin");
    LIMN_FIELD(facing, "the points face each other: half a turn about their y axis");
}

/// The Attach that was applied last.
struct AttachState {
    Attach applied;
};

LIMN_FIELDS(AttachState) {
    LIMN_FIELD(applied, "what was applied last");
}
template <>
struct ComponentTraits<AttachState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
