#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

namespace limn {

/// A view along the entity's local -z, +y up (as glTF).
struct Camera {
    float fov_y = radians(50.0f);  ///< full vertical angle [rad], 0 < fov_y < pi
    float near = 0.05f;  ///< [m], > 0; there is no far plane: depth is reversed, 0 at infinity
    bool active =
        true;  ///< the first active camera in world order is rendered, unless one is named
};

/// Third-person camera: the entity circles `target` (engine.camera-orbit, engine.camera-lag).
struct OrbitCamera {
    Entity target;            ///< held where it is when the target is gone
    Vec3 offset = {0, 0, 0};  ///< of the point looked at, in the target's space [m]
    float azimuth = 0.0f;     ///< about the target's +y, from +z toward +x [rad]
    float elevation = 0.3f;   ///< [rad], -pi/2 .. pi/2, exclusive
    float distance = 5.0f;    ///< [m], > 0
    float follow = 0.9f;      ///< share of the way gone in 1/60 s, 0 .. 1; 1 = rigid
};

/// First-person camera moved by input.
struct FlyCamera {
    float speed = 3.0f;          ///< [m/s]
    float sensitivity = 0.003f;  ///< [rad] a pixel
};

template <typename Visitor>
void visit_fields(Camera& camera, Visitor&& visit) {
    visit(
        "fov_y", camera.fov_y,
        {.doc = "full vertical angle", .unit = "rad", .min = 0.01, .max = 3.1});
    visit("near", camera.near, {.doc = "near plane", .unit = "m", .min = 1e-4, .max = 100});
    visit("active", camera.active, {.doc = "may be the one that is rendered"});
}

template <typename Visitor>
void visit_fields(OrbitCamera& orbit, Visitor&& visit) {
    visit("target", orbit.target, {.doc = "entity it circles, by name"});
    visit("offset", orbit.offset, {.doc = "of the point looked at", .unit = "m"});
    visit("azimuth", orbit.azimuth, {.doc = "about +y, from +z toward +x", .unit = "rad"});
    visit(
        "elevation", orbit.elevation,
        {.doc = "above the horizon", .unit = "rad", .min = -1.55, .max = 1.55});
    visit(
        "distance", orbit.distance,
        {.doc = "to the point looked at", .unit = "m", .min = 0.01, .max = 10000});
    visit(
        "follow", orbit.follow,
        {.doc = "share of the way gone in 1/60 s; 1 = rigid", .min = 0, .max = 1});
}

template <typename Visitor>
void visit_fields(FlyCamera& fly, Visitor&& visit) {
    visit("speed", fly.speed, {.doc = "of motion", .unit = "m/s", .min = 0, .max = 1000});
    visit(
        "sensitivity", fly.sensitivity,
        {.doc = "rotation for a pixel of mouse motion", .unit = "rad", .min = 0, .max = 1});
}

}  // namespace limn
