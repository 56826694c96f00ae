#pragma once

#include "content/make/models/creature.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

// A robot arm with seven axes, as in factories: alternately about its length and across it. It
// stands on y = 0 and points up at rest; its reach above the shoulder is 0.94 of its size. Joints:
// "base", "turn", "shoulder", "upper turn", "elbow", "lower turn", "wrist", "tool turn", each of
// the last seven with a freedom and its limits. The point between the jaws is 0.15 size above
// "tool turn".

enum class RobotArmPart : std::uint8_t {
    Shell,   ///< painted covers
    Metal,   ///< rings, caps, jaws
    Limits,  ///< a sector for the range of each axis across, and a pointer on the moving side
};

struct RobotArmShape {
    RobotArmPart part = RobotArmPart::Shell;
    float size = 1.0f;
    float range = 1.0f;
    int segments = 40;
};

LIMN_FIELDS(RobotArmShape) {
    LIMN_FIELD(part, .doc = "which part", .values = "shell metal limits");
    LIMN_FIELD(size, "1: 1.3 m high, stretched", "", 0.01, 100);
    LIMN_FIELD(range, "factor on the limits of all joints", "", 0.05, 1);
    LIMN_FIELD(segments, "around each axis", "", 8, 256);
}

[[nodiscard]] MeshData make_robot_arm(const RobotArmShape& shape);
[[nodiscard]] MeshRig make_robot_arm_rig(const RobotArmShape& shape);

}  // namespace limn
