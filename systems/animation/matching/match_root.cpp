#include "systems/animation/matching/match_root.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.motion-select

namespace limn {
namespace {

constexpr float kAngleGain = 3.0f;   // of the angle that is left to turn [1/s]
constexpr float kSideways = 3.2f;    // largest acceleration across the way [m/s^2]
constexpr float kBrake = 1.5f;       // deceleration, of the acceleration
constexpr float kTurnDelay = 0.12f;  // time constant of turns [s]
constexpr float kAnyWish = 0.05f;    // slower ones have no direction [m/s]
constexpr float kAnyFacing = 1e-3f;

float follow(float dt, float response) {
    return 1 - std::exp(-dt / response);
}

}  // namespace

void step_match_root(const MatchWish& wish, float dt, MatchRoot& root) {
    const float speed = glm::length(wish.velocity);
    const bool faces = glm::length(wish.facing) > kAnyFacing;
    const Vec2 toward = faces ? wish.facing : wish.velocity;
    float angle = 0;
    if (faces || speed > kAnyWish) {
        angle = std::remainder(std::atan2(toward.x, toward.y) - root.heading, 2 * kPi);
    }
    Vec2 wanted = wish.velocity;
    if (!faces) {
        const float ahead = std::max(std::cos(angle), 0.0f);
        wanted = ahead * speed * Vec2(std::sin(root.heading), std::cos(root.heading));
    }
    const float moving = glm::length(root.velocity);
    const float most_turn = std::min(wish.turn_speed, kSideways / std::max(moving, 0.1f));
    const float turn = std::clamp(kAngleGain * angle, -most_turn, most_turn);
    root.turn += follow(dt, kTurnDelay) * (turn - root.turn);
    const float share = follow(dt, wish.response);
    root.pull += share * (wanted - root.pull);
    const Vec2 gain = root.pull - root.velocity;
    const float size = glm::length(gain);
    const float brake = glm::dot(gain, root.velocity) < 0 ? kBrake : 1.0f;
    const float most = brake * wish.acceleration * wish.response;
    root.velocity += share * (size > most ? most / size * gain : gain);
    root.place += dt * root.velocity;
    root.heading += dt * root.turn;
}

}  // namespace limn
