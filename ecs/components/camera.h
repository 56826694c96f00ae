#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

namespace limn {

/// Camera that looks along the entity's local -z, +y up (as in glTF).
struct Camera {
    float fov_y = radians(50.0f);
    float ortho_height = 0;  ///< > 0: orthographic, with an image that is so high [m]
    float near = 0.05f;      ///< near plane [m], > 0; no far plane: reversed depth, 0 at infinity
    bool active = true;  ///< the first active camera in world order is rendered, unless another is
                         ///< selected by name
};

LIMN_FIELDS(Camera) {
    LIMN_FIELD(fov_y, "full vertical field of view", "rad", 0.01, 3.1);
    LIMN_FIELD(
        ortho_height, "of an orthographic camera: height of what fills the image; 0 = perspective",
        "m", 0, 1e6);
    LIMN_FIELD(near, "distance of the near plane", "m", 1e-4, 100);
    LIMN_FIELD(active, "eligible for rendering; the first active camera is used");
}

/// Third-person camera: the entity orbits `target` (engine.camera-orbit, engine.camera-lag).
struct OrbitCamera {
    Entity target;  ///< the camera stays where it is when the target no longer exists
    Vec3 offset = {0, 0, 0};
    float azimuth = 0.0f;
    float elevation = 0.3f;
    float distance = 5.0f;
    float follow = 0.9f;
    bool turns = true;
    float clearance = 0.0f;
};

LIMN_FIELDS(OrbitCamera) {
    LIMN_FIELD(target, "entity that the camera orbits, by name");
    LIMN_FIELD(offset, "offset of the look-at point, in the target's space", "m");
    LIMN_FIELD(azimuth, "orbit angle about +y, from +z toward +x", "rad");
    LIMN_FIELD(elevation, "orbit angle above the horizon", "rad", -1.55, 1.55);
    LIMN_FIELD(distance, "distance to the look-at point", "m", 0.01, 10000);
    LIMN_FIELD(follow, "fraction of the remaining distance covered in 1/60 s; 1 = rigid", "", 0, 1);
    LIMN_FIELD(
        turns, "azimuth and elevation refer to the axes of the target; or else of the world");
    LIMN_FIELD(
        clearance,
        "comes closer where Walkable meshes would hide the target, rises over characters between, "
        "and stays this far before all of them; 0: passes through",
        "m", 0, 10);
}

/// Free-flying first-person camera, controlled by Input.
struct FlyCamera {
    float speed = 3.0f;
    float sensitivity = 0.003f;
};

LIMN_FIELDS(FlyCamera) {
    LIMN_FIELD(speed, "movement speed", "m/s", 0, 1000);
    LIMN_FIELD(sensitivity, "rotation per pixel of mouse motion", "rad", 0, 1);
}

}  // namespace limn
