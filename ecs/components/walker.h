#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

namespace limn {

/// Walks on what has a Footing, wades where there is water and swims where it cannot stand. Its
/// Transform is between its feet; a camera that is its child looks out of its eyes. Its heading is
/// along -z.
struct Walker {
    float speed = 2.4f;         ///< on dry land [m/s], > 0
    float eye = 1.5f;           ///< above its feet [m], > 0
    float radius = 0.28f;       ///< of the cylinder that walls stop [m]
    float step = 0.4f;          ///< that it climbs without a jump [m]
    Entity camera{};            ///< its eyes, a child; it obeys Input only while this one is active
    float yaw = 0.0f;           ///< to the left [rad]
    float pitch = 0.0f;         ///< up [rad]
    Vec3 velocity = {0, 0, 0};  ///< [m/s]
    float depth = 0.0f;         ///< of the water above its feet [m], < 0: none
    float duck = 0.0f;          ///< 0 upright .. 1 its head as low as it gets, under water
    bool stands = false;        ///< on something
};

/// A box that walkers stand on and do not walk through, upright.
struct Footing {
    Vec3 half = {0.5f, 0.5f, 0.5f};  ///< half extents in its own space [m]
    Vec3 offset = {0, 0, 0};         ///< of its middle in its own space [m]
};

template <typename Visitor>
void visit_fields(Walker& walker, Visitor&& visit) {
    visit("speed", walker.speed, {.doc = "on dry land", .unit = "m/s", .min = 0, .max = 100});
    visit("eye", walker.eye, {.doc = "above its feet", .unit = "m", .min = 0.05, .max = 100});
    visit(
        "radius", walker.radius, {.doc = "that walls keep off", .unit = "m", .min = 0, .max = 10});
    visit("step", walker.step, {.doc = "that it climbs", .unit = "m", .min = 0, .max = 10});
    visit("camera", walker.camera, {.doc = "its eyes: a child, by name"});
    visit("yaw", walker.yaw, {.doc = "to the left", .unit = "rad"});
    visit("pitch", walker.pitch, {.doc = "up", .unit = "rad", .min = -1.5, .max = 1.5});
    visit("velocity", walker.velocity, {.doc = "of its feet", .unit = "m/s"});
    visit("depth", walker.depth, {.doc = "of the water above its feet", .unit = "m"});
    visit("duck", walker.duck, {.doc = "0 upright, 1 head under water", .min = 0, .max = 1});
    visit("stands", walker.stands, {.doc = "on something"});
}

template <typename Visitor>
void visit_fields(Footing& footing, Visitor&& visit) {
    visit(
        "half", footing.half,
        {.doc = "half extents in its own space", .unit = "m", .min = 0, .max = 1e4});
    visit("offset", footing.offset, {.doc = "of its middle in its own space", .unit = "m"});
}

}  // namespace limn
