#pragma once

#include "ecs/base/math.h"

namespace limn {

// How a person's root moves who wants to go somewhere: the takes are performed along such paths,
// and such a path is what a character wants that follows its MoveIntent. So the takes have what is
// wanted.
// Techniques: char.motion-select

/// A root on the ground and how it moves. Points are x and z [m]; headings are about +y from +z
/// [rad].
struct MatchRoot {
    Vec2 place = {0, 0};
    float heading = 0.0f;
    Vec2 velocity = {0, 0};  ///< [m/s]
    Vec2 pull = {0, 0};      ///< what the velocity tends to [m/s]
    float turn = 0.0f;       ///< [rad/s]
};

/// Where it wants to go.
struct MatchWish {
    Vec2 velocity = {0, 0};     ///< [m/s]
    Vec2 facing = {0, 0};       ///< any length; 0: along the velocity
    float response = 0.22f;     ///< time constant of speeds [s], > 0
    float acceleration = 2.2f;  ///< largest; brakes harder [m/s^2]
    float turn_speed = 2.2f;    ///< fastest turn [rad/s]
};

/// One step of `dt` [s], at most 0.1. Who does not face elsewhere goes where he faces, slower while
/// he turns.
void step_match_root(const MatchWish& wish, float dt, MatchRoot& root);

}  // namespace limn
