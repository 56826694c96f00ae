#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <vector>

namespace limn {

/// A part of a joined mesh: its vertices are scaled, then rotated, then translated.
struct JoinedPart {
    MeshId mesh;
    Vec3 position = {0, 0, 0};
    Quat rotation = {1, 0, 0, 0};
    Vec3 scale = {1, 1, 1};
    Vec3 color = {1, 1, 1};
};

LIMN_FIELDS(JoinedPart) {
    LIMN_FIELD(mesh, "a mesh of the level, by name; must come earlier in the file");
    LIMN_FIELD(position, "of its origin", "m");
    LIMN_FIELD(rotation, "unit quaternion x y z w, or Euler angles [yaw, pitch, roll] in degrees");
    LIMN_FIELD(scale, "along each axis of the mesh", "", 0.001, 1000);
    LIMN_FIELD(color, "linear factor on the color of the material", "", 0, 1);
}

struct JoinedShape {
    std::vector<JoinedPart> parts;
};

LIMN_FIELDS(JoinedShape) {
    LIMN_FIELD(parts, "in any order");
}

/// Several meshes of the level as one, at rest: for what can only draw a single mesh, such as
/// particles. Omits skins and morph targets, and parts without a mesh or beyond a million vertices.
[[nodiscard]] MeshData make_joined(const JoinedShape& shape, const Assets& assets);

}  // namespace limn
