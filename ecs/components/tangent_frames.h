#pragma once

#include "ecs/reflect.h"

namespace limn {

/// Resource: draws the tangent frames of all vertices as lines, tangents green, bitangents blue,
/// normals red (bump.frame-view). None if absent or of length 0.
struct TangentFrames {
    float length = 0.05f;
};

LIMN_FIELDS(TangentFrames) {
    LIMN_FIELD(length, "of the lines", "m", 0, 1000);
}

}  // namespace limn
