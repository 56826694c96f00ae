#pragma once

#include "ecs/base/math.h"
#include "ecs/components/path.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// Beside a Floating: a boat with one sail, a keel and a rudder, +z ahead, +x to port. The wind is
/// that of Weather. Somebody steers it by Input, or it follows a course by itself.
struct Sailboat {
    float sail_area = 22.0f;                 ///< [m^2]
    Vec3 sail_center = {0, 3.0f, 0.2f};      ///< where the wind's force attacks [m]
    float keel_area = 1.1f;                  ///< [m^2]
    Vec3 keel_center = {0, -0.8f, 0.3f};     ///< [m]
    float rudder_area = 0.3f;                ///< [m^2]
    Vec3 rudder_center = {0, -0.5f, -2.4f};  ///< [m]
    float wave_drag = 0.06f;  ///< resistance of its own waves at hull speed, of its weight

    float rudder = 0.0f;       ///< -1 .. 1, > 0 turns to starboard
    float sheet = 0.3f;        ///< 0 hauled in .. 1 let out
    float boom = 0.0f;         ///< off the middle, to port [rad]
    bool trims_itself = true;  ///< the sheet follows the wind

    bool player = false;    ///< obeys Input, from the moment that there is some
    Entity camera{};        ///< only while this one is active; none: always
    Entity lookout{};       ///< goes with it, upright: for cameras to follow; none: nobody
    bool taken = false;     ///< somebody steers it
    PathId course{};        ///< that it follows by itself; none: as it is steered
    double distance = 0.0;  ///< along the course, of the point that it makes for [m]
    std::int32_t tack = 1;  ///< beating: the wind comes from port (1) or starboard (-1)
};

/// On a child of a Sailboat: turns with the boom about its own +y; its sail, whose belly is along
/// +x, fills to the side where it is.
struct Boom {
    float fullness = 0.0f;  ///< -1 .. 1
};

template <typename Visitor>
void visit_fields(Sailboat& boat, Visitor&& visit) {
    visit("sail_area", boat.sail_area, {.doc = "of the sail", .unit = "m^2", .min = 0, .max = 1e4});
    visit("sail_center", boat.sail_center, {.doc = "where the wind's force attacks", .unit = "m"});
    visit(
        "keel_area", boat.keel_area,
        {.doc = "of the keel, under water", .unit = "m^2", .min = 0, .max = 1e4});
    visit("keel_center", boat.keel_center, {.doc = "where the water's force attacks", .unit = "m"});
    visit(
        "rudder_area", boat.rudder_area,
        {.doc = "of the rudder", .unit = "m^2", .min = 0, .max = 1e4});
    visit("rudder_center", boat.rudder_center, {.doc = "likewise", .unit = "m"});
    visit(
        "wave_drag", boat.wave_drag,
        {.doc = "resistance of its own waves at hull speed, of its weight", .min = 0, .max = 10});
    visit("rudder", boat.rudder, {.doc = "> 0 turns to starboard", .min = -1, .max = 1});
    visit("sheet", boat.sheet, {.doc = "0 hauled in, 1 let out", .min = 0, .max = 1});
    visit("boom", boat.boom, {.doc = "off the middle, to port", .unit = "rad"});
    visit("trims_itself", boat.trims_itself, {.doc = "the sheet follows the wind"});
    visit("player", boat.player, {.doc = "obeys the input, once there is some"});
    visit("camera", boat.camera, {.doc = "only while this one is active, by name"});
    visit("lookout", boat.lookout, {.doc = "goes with it, upright: for cameras to follow"});
    visit("taken", boat.taken, {.doc = "somebody steers it"});
    visit("course", boat.course, {.doc = "a path of the level that it follows by itself"});
    visit(
        "distance", boat.distance,
        {.doc = "along the course, of what it makes for", .unit = "m", .min = 0, .max = 1e7});
    visit(
        "tack", boat.tack, {.doc = "beating: wind from port 1, starboard -1", .min = -1, .max = 1});
}

template <typename Visitor>
void visit_fields(Boom& boom, Visitor&& visit) {
    visit("fullness", boom.fullness, {.doc = "of the sail, to port", .min = -1, .max = 1});
}

}  // namespace limn
