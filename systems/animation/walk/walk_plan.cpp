#include "systems/animation/walk/walk_plan.h"

#include "ecs/base/foot_flight.h"
#include "ecs/base/gravity.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.foot-flight, char.walk-control, char.walk-cycle

namespace limn {
namespace {

constexpr auto kGravityPull = static_cast<float>(kGravity);  // [m/s^2]
constexpr float kMaxFroude = 0.55f;                          // v^2 / (g leg) of the fastest walk
constexpr float kNaturalStride = 1.6f;                       // [leg lengths]
constexpr float kLongestStride = 1.9f;                       // [leg lengths]
constexpr float kSlowestCycle = 1.4f;     // relative to that at the comfortable speed
constexpr float kSidewaysStretch = 0.4f;  // of strides
constexpr float kBackwardStretch = 0.65f;
constexpr float kTurnCadence = 0.8f;  // speed that turns count as [leg lengths]
constexpr float kMaxToeing = 0.8f;    // of a print against the root when it is made [rad]
constexpr float kStanceAhead = 0.4f;  // of the time on the ground until the root is above the foot
constexpr float kReachAhead = 0.62f;  // farthest that a foot lands from the root [leg lengths]
constexpr float kApart = 0.09f;       // least distance of the feet sideways [leg lengths]
constexpr float kFlatAt = 0.6f;       // of a flight, where the foot is level
constexpr float kHeelRise = 0.18f;    // of the way behind, where heels begin to rise
constexpr float kGainLasts = 0.3f;    // for which an acceleration is expected to go on [s]
constexpr float kRunNearer = 0.05f;   // runners land nearer to the point below them
constexpr float kRunCycle = 2.65f;    // of a run, of sqrt(leg / gravity)
constexpr float kRunQuicker = 0.2f;   // of it per speed, of sqrt(leg gravity)

float smooth_step(float t) {
    return t * t * (3 - 2 * t);
}

float power_of_8(float x) {
    return square(square(square(x)));
}

Vec3 left_of(float heading) {
    return {std::cos(heading), 0, -std::sin(heading)};
}

LegWeights clamp_weights(const LegWeights& weights) {
    const auto share = [](float w) { return std::clamp(finite_or(w, 1.0f), 0.0f, 1.0f); };
    return {share(weights.hip), share(weights.knee), share(weights.ankle)};
}

}  // namespace

float wrap_angle(float angle) {
    return std::remainder(angle, 2 * kPi);
}

Vec3 heading_direction(float heading) {
    return {std::sin(heading), 0, std::cos(heading)};
}

Walk effective_walk(const Walk& walk) {
    Walk style = walk;
    const float tired = std::clamp(finite_or(walk.tiredness, 0.0f), 0.0f, 1.0f);
    style.tiredness = tired;
    style.speed = std::max(finite_or(walk.speed, 1.3f), 0.05f) * (1 - 0.35f * tired);
    style.stride = std::max(finite_or(walk.stride, 0.0f), 0.0f);
    style.step_height = std::max(finite_or(walk.step_height, 0.0f), 0.0f) * (1 - 0.5f * tired);
    style.plateau = std::clamp(finite_or(walk.plateau, 0.0f), 0.0f, 1.0f);
    style.knee_bend = std::clamp(finite_or(walk.knee_bend, 0.0f) + 0.035f * tired, 0.0f, 0.5f);
    style.stoop = finite_or(walk.stoop, 0.0f) + 0.25f * tired;
    style.width = std::max(finite_or(walk.width, 0.7f), 0.05f);
    style.toe_off = std::clamp(finite_or(walk.toe_off, 0.0f), 0.0f, 1.3f) * (1 - 0.4f * tired);
    style.heel_strike =
        std::clamp(finite_or(walk.heel_strike, 0.0f), 0.0f, 0.8f) * (1 - 0.6f * tired);
    style.left = clamp_weights(walk.left);
    style.right = clamp_weights(walk.right);
    style.sway = finite_or(walk.sway, 0.0f) + 0.015f * tired;
    style.arm_swing = finite_or(walk.arm_swing, 0.0f) * (1 - 0.6f * tired);
    style.arms = std::clamp(finite_or(walk.arms, 1.0f), 0.0f, 1.0f);
    style.response = std::max(finite_or(walk.response, 0.2f), 0.02f) * (1 + tired);
    style.turn_speed = std::max(finite_or(walk.turn_speed, 1.8f), 0.05f);
    return style;
}

float max_walk_speed(float leg) {
    return std::sqrt(kMaxFroude * kGravityPull * leg);
}

float run_share(float leg, float speed) {
    return smooth_step(std::clamp((speed / max_walk_speed(leg) - 1.02f) / 0.38f, 0.0f, 1.0f));
}

float stride_stretch(const Vec3& velocity, float heading) {
    const float speed2 = glm::dot(velocity, velocity);
    const float along = glm::dot(velocity, heading_direction(heading));
    const float share = speed2 > 1e-12f ? along * along / speed2 : 1.0f;
    return glm::mix(kSidewaysStretch, along > 0 ? 1.0f : kBackwardStretch, share);
}

WalkStride find_stride(const Walk& walk, float leg, float speed, float stretch) {
    const float natural = walk.stride > 0 ? walk.stride : kNaturalStride * leg;
    const float tired = 1 - 0.2f * walk.tiredness;
    const float longest = kLongestStride * leg;
    const float comfortable = std::min(natural * tired, longest);
    // The cadence is 1 at the comfortable speed, and never less than a part of it, smoothly.
    constexpr float kLeast = 1 / kSlowestCycle;
    const float least = power_of_8(kLeast);
    const float cadence = std::pow(
        (power_of_8(std::sqrt(speed / walk.speed) / stretch) + least) / (1 + least), 0.125f);
    const float duration =
        std::min(comfortable / (walk.speed * cadence), stretch * longest / std::max(speed, 1e-6f));
    return {duration, speed * duration};
}

float speed_soon(const WalkMotion& motion) {
    return std::max(
        glm::length(motion.velocity), glm::length(motion.velocity + kGainLasts * motion.gain));
}

WalkStride find_stride(const Walk& walk, float leg, const WalkMotion& motion) {
    const float speed = speed_soon(motion);
    const float turn = kTurnCadence * leg * std::abs(motion.turn);
    const float stretch = stride_stretch(motion.velocity, motion.heading);
    WalkStride stride = find_stride(walk, leg, std::sqrt(speed * speed + turn * turn), stretch);
    const float fast = speed / std::sqrt(kGravityPull * leg);
    const float run =
        std::sqrt(leg / kGravityPull) * std::max(kRunCycle - kRunQuicker * fast, 0.6f * kRunCycle);
    stride.duration = glm::mix(stride.duration, run, run_share(leg, speed));
    stride.length = speed * stride.duration;
    return stride;
}

float step_duration(const Walk& walk, std::uint32_t foot, float cycle) {
    const float own = leg_weights(walk, foot).hip;
    const float other = leg_weights(walk, 1 - foot).hip;
    return 0.5f * cycle * (1 - 0.35f * (1 - other)) * (1 + 0.2f * (1 - own));
}

WalkForecast forecast_root(const WalkMotion& motion, float time) {
    const float gaining = std::min(time, kGainLasts);
    Vec3 way = time * motion.velocity + gaining * (time - 0.5f * gaining) * motion.gain;
    if (motion.response > 0) {
        const float t = time / motion.response;
        const float decay = std::exp(-t);
        way = time * motion.wanted
              + motion.response * (1 - decay) * (motion.velocity - motion.wanted)
              + motion.response * (1 - decay * (1 + t)) * (motion.pull - motion.wanted);
    }
    // The velocity turns with the heading.
    const float half = 0.5f * motion.turn * time;
    const float c = std::cos(half);
    const float s = std::sin(half);
    const Vec3 turned = {c * way.x + s * way.z, way.y, c * way.z - s * way.x};
    return {motion.root + turned, motion.heading + motion.turn * time};
}

Footprint
home_print(const Walk& walk, const WalkSize& size, std::uint32_t foot, const WalkForecast& root) {
    return {root.root + walk.width * size.sides[foot] * left_of(root.heading), root.heading};
}

Footprint plan_footprint(
    const Walk& walk, const WalkSize& size, const WalkMotion& motion, std::uint32_t foot,
    float time_left, const Footprint& stance) {
    const float cycle = find_stride(walk, size.leg, motion).duration;
    const float run = run_share(size.leg, speed_soon(motion));
    const float on_ground = (1 - 0.5f * flight_steps(run)) * cycle;
    const float ahead = (kStanceAhead - kRunNearer * run) * on_ground
                        * (0.35f + 0.65f * leg_weights(walk, foot).hip);
    const WalkForecast landing = forecast_root(motion, time_left);
    Footprint print = home_print(walk, size, foot, forecast_root(motion, time_left + ahead));
    const Vec3 way = print.place - landing.root;
    const float far = glm::length(way);
    if (far > kReachAhead * size.leg) {
        print.place = landing.root + (kReachAhead * size.leg / far) * way;
    }
    const float toeing = wrap_angle(print.heading - landing.heading);
    print.heading = landing.heading + std::clamp(toeing, -kMaxToeing, kMaxToeing);
    const Vec3 outward = (foot == 0 ? 1.0f : -1.0f) * left_of(print.heading);
    const float apart = glm::dot(print.place - stance.place, outward);
    print.place += std::max(kApart * size.leg - apart, 0.0f) * outward;
    return print;
}

float kick_height(float s) {
    const float left = std::clamp(1 - s, 0.0f, 1.0f);
    return square(std::sin(kPi * (1 - left * std::sqrt(left))));
}

Vec2 flight_point(const Walk& walk, float s) {
    const std::vector<Vec2>& points = walk.flight;
    if (points.size() < 3) {
        return {smooth_step(s), 0.5f * flight_height(s, walk.plateau)};
    }
    const auto last = static_cast<int>(points.size()) - 1;
    const float at = std::clamp(s, 0.0f, 1.0f) * static_cast<float>(last);
    const int first = std::min(static_cast<int>(at), last - 1);
    const float t = at - static_cast<float>(first);
    // Before the first and after the last point the foot stands.
    const auto point = [&](int i) {
        return points[static_cast<std::size_t>(std::clamp(i, 0, last))];
    };
    const auto slope = [&](int i) {
        return i == 0 || i == last ? Vec2(0) : 0.5f * (point(i + 1) - point(i - 1));
    };
    const float ease = smooth_step(t);
    return glm::mix(point(first), point(first + 1), ease)
           + t * (1 - t) * ((1 - t) * slope(first) - t * slope(first + 1));
}

float toe_off_pitch(const Walk& walk, std::uint32_t foot, float behind) {
    const float x = std::max((behind - kHeelRise) / (1 - kHeelRise), 0.0f);
    // Quadratic, then up to a quarter more: toes stay on the ground.
    const float shape = x < 1 ? x * x : 1.25f - 0.25f * std::exp(-8 * (x - 1));
    return -walk.toe_off * leg_weights(walk, foot).ankle * shape;
}

float flight_pitch(float lift, float lift_rate, float strike, float s, float duration) {
    if (s >= kFlatAt) {
        return strike * smooth_step(std::min((s - kFlatAt) / (1 - kFlatAt), 1.0f));
    }
    // Cubic Hermite with a slope of 0 at the end.
    const float t = s / kFlatAt;
    const float rate = lift_rate * duration * kFlatAt;
    return lift * (1 - smooth_step(t)) + rate * t * (1 - t) * (1 - t);
}

float landing_pitch(float strike, float r) {
    return strike * (1 - smooth_step(std::clamp(r, 0.0f, 1.0f)));
}

}  // namespace limn
