#pragma once

#include "ecs/base/math.h"
#include "ecs/components/path.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

namespace limn {

/// Hovers along a path, driven by a player or autonomously. +z is ahead. Its state is in path
/// coordinates: distance along the path and lateral offset to the right.
struct Racer {
    PathId track{};
    double distance = 0.0;
    float speed = 0.0f;
    float half_width = 6.0f;
    float height = 0.6f;
    float top_speed = 60.0f;
    float boost_speed = 90.0f;
    float acceleration = 20.0f;
    float grip = 40.0f;
    float lane = 0.0f;
    bool player = false;
};

LIMN_FIELDS(Racer) {
    LIMN_FIELD(track, "a path of the level, by name");
    LIMN_FIELD(distance, "initial distance along the track", "m", 0, 1e6);
    LIMN_FIELD(speed, "initial speed", "m/s", 0, 1000);
    LIMN_FIELD(half_width, "half width of the track, up to its walls", "m", 0, 1000);
    LIMN_FIELD(height, "height above the track", "m", -10, 100);
    LIMN_FIELD(top_speed, "top speed without boost", "m/s", 0, 1000);
    LIMN_FIELD(boost_speed, "top speed with boost", "m/s", 0, 1000);
    LIMN_FIELD(acceleration, "acceleration from rest", "m/s^2", 0.01, 1000);
    LIMN_FIELD(grip, "largest lateral acceleration of the autopilot", "m/s^2", 0.01, 1000);
    LIMN_FIELD(lane, "lateral offset preferred by the autopilot, to the right", "m");
    LIMN_FIELD(player, "controlled by Input, once a player uses it");
}

/// State of a Racer, starting from its initial distance and speed.
struct RacerState {
    double distance = 0.0;
    float lateral = 0.0f;
    float heading = 0.0f;
    float speed = 0.0f;
    float lean = 0.0f;
    float energy = 1.0f;
    bool boosting = false;
    bool player_active = false;
};

LIMN_FIELDS(RacerState) {
    LIMN_FIELD(distance, "distance along the track", "m", 0, 1e6);
    LIMN_FIELD(lateral, "offset to the right of the track's center", "m", -1e3, 1e3);
    LIMN_FIELD(heading, "heading relative to the track, to the right", "rad", -3.2, 3.2);
    LIMN_FIELD(speed, "speed along its heading", "m/s", 0, 1000);
    LIMN_FIELD(lean, "lean into the turn, to the right", "rad", -3.2, 3.2);
    LIMN_FIELD(energy, "energy remaining for boosts", "", 0, 1);
    LIMN_FIELD(boosting, "currently boosting");
    LIMN_FIELD(player_active, "a player has taken control");
}

/// On a Camera: widens the field of view and the shutter with the speed of `racer`.
struct SpeedView {
    Entity racer{};
    float slow_fov = radians(50.0f);
    float fast_fov = radians(72.0f);
    float slow_shutter = 120.0f;
    float fast_shutter = 270.0f;
};

LIMN_FIELDS(SpeedView) {
    LIMN_FIELD(racer, "racer whose speed is used, by name");
    LIMN_FIELD(slow_fov, "field of view at rest", "rad", 0.01, 3.1);
    LIMN_FIELD(fast_fov, "field of view at boost speed", "rad", 0.01, 3.1);
    LIMN_FIELD(slow_shutter, "shutter angle of motion blur at rest", "deg", 0, 360);
    LIMN_FIELD(fast_shutter, "shutter angle of motion blur at boost speed", "deg", 0, 360);
}

}  // namespace limn
