#pragma once

#include "ecs/components/walk.h"

namespace limn {

// Where and when the next foot lands: from speed, turn and the style of a walk. Pure functions of
// plain values.
// Techniques: char.foot-flight, char.walk-control, char.walk-cycle

inline constexpr float kFlightShare = 0.75f;  ///< of a step; then both feet are on the ground
inline constexpr float kRunFlight = 1.45f;    ///< steps; the feet fly together for 0.45 of a step

/// Where the feet of a body stand, in the space in which it walks.
struct WalkSize {
    float leg = 0.9f;                            ///< thigh and shin [m]
    std::array<float, 2> sides = {0.1f, -0.1f};  ///< of left and right foot, to the left [m]
};

/// The style with what tiredness does to it, and fields in their ranges.
[[nodiscard]] Walk effective_walk(const Walk& walk);

/// Fastest walk of a leg of this length [m/s]: 2.2 m/s for 0.9 m. The centripetal acceleration of
/// the hips above the foot on the ground is 0.55 of gravity then; people run from there on.
[[nodiscard]] float max_walk_speed(float leg);

/// From 0, a walk, up to 1 at 1.4 times the speed of the fastest walk.
[[nodiscard]] float run_share(float leg, float speed);

/// How long a foot flies in a walk that is a run by this share [steps].
[[nodiscard]] inline float flight_steps(float run) {
    return kFlightShare + run * (kRunFlight - kFlightShare);
}

/// Progress of the flight of a foot; >= 1: it is on the ground.
[[nodiscard]] inline float flight_progress(const WalkState& state, std::uint32_t foot) {
    const float steps = state.step + (foot == state.flying ? 0.0f : 1.0f);
    return state.flying == WalkState::kNoFoot ? 1.0f : steps / state.feet[foot].flight;
}

/// A cycle, two steps, at a speed.
struct WalkStride {
    float duration = 1.0f;  ///< [s]
    float length = 0.0f;    ///< [m]
};
/// Length and cadence both grow with the root of the speed, as people's do; no longer than legs
/// allow, and no slower than 1.4 times the cycle at the comfortable speed. `stretch`: of strides,
/// 1: ahead.
[[nodiscard]] WalkStride
find_stride(const Walk& walk, float leg, float speed, float stretch = 1.0f);

/// How far steps into a direction go, relative to those ahead: less sideways and backward.
[[nodiscard]] float stride_stretch(const Vec3& velocity, float heading);

/// Duration of the step in which `foot` flies, for a cycle [s]: shorter above a weak leg.
[[nodiscard]] float step_duration(const Walk& walk, std::uint32_t foot, float cycle);

/// The root and how it moves.
struct WalkMotion {
    Vec3 root = {0, 0, 0};      ///< [m]
    float heading = 0.0f;       ///< [rad]
    Vec3 velocity = {0, 0, 0};  ///< [m/s]
    Vec3 pull = {0, 0, 0};      ///< what the velocity tends to [m/s]
    Vec3 wanted = {0, 0, 0};    ///< what `pull` tends to [m/s]
    float turn = 0.0f;          ///< [rad/s]
    float response = 0.0f;      ///< time constant of both [s]; 0: `gain` changes it for a while
    Vec3 gain = {0, 0, 0};      ///< acceleration of a root that something else moves [m/s^2]
};

/// The speed that steps are made for: that at which they end, if it is higher.
[[nodiscard]] float speed_soon(const WalkMotion& motion);

/// The cycle for this motion; turns take steps, too. Runs take steps at a nearly constant rate.
[[nodiscard]] WalkStride find_stride(const Walk& walk, float leg, const WalkMotion& motion);

/// Root and heading after `time` [s], if nothing else is wanted meanwhile; in closed form.
struct WalkForecast {
    Vec3 root = {0, 0, 0};
    float heading = 0.0f;
};
[[nodiscard]] WalkForecast forecast_root(const WalkMotion& motion, float time);

/// A place for a foot.
struct Footprint {
    Vec3 place = {0, 0, 0};  ///< [m]
    float heading = 0.0f;    ///< [rad]
};

/// Where `foot` stands beside the root.
[[nodiscard]] Footprint
home_print(const Walk& walk, const WalkSize& size, std::uint32_t foot, const WalkForecast& root);

/// Where `foot` has to land in `time_left` seconds, the other one standing on `stance`: so that the
/// root passes over it in the middle of its time on the ground, no farther than the leg reaches,
/// and not on the other foot.
[[nodiscard]] Footprint plan_footprint(
    const Walk& walk, const WalkSize& size, const WalkMotion& motion, std::uint32_t foot,
    float time_left, const Footprint& stance);

/// Height of the foot of a runner, 0 to 1: highest early, while the heel is behind the body.
[[nodiscard]] float kick_height(float s);

/// Where a flying foot is at `s`, 0 to 1: forward, 0 to 1 of its step, and height, 0 to 1. Eased by
/// 3 s^2 - 2 s^3, so that the foot lands without speed, at the height of foot_flight.h; or by the
/// walk's own curve, through its points (Catmull-Rom).
[[nodiscard]] Vec2 flight_point(const Walk& walk, float s);

/// Pitch of a foot on the ground that the root has left behind, 1: by as much as when it leaves the
/// ground [rad].
[[nodiscard]] float toe_off_pitch(const Walk& walk, std::uint32_t foot, float behind);

/// Pitch in flight: from `lift` and its rate [rad/s] to flat, then to the pitch of the landing. `s`
/// from 0 to 1; `duration` of the flight [s].
[[nodiscard]] float
flight_pitch(float lift, float lift_rate, float strike, float s, float duration);

/// Pitch of a foot that rolls from its heel to its sole, `r` from 0 to 1.
[[nodiscard]] float landing_pitch(float strike, float r);

[[nodiscard]] inline const LegWeights& leg_weights(const Walk& walk, std::uint32_t foot) {
    return foot == 0 ? walk.left : walk.right;
}

/// Of an angle, the same between -pi and pi.
[[nodiscard]] float wrap_angle(float angle);

[[nodiscard]] Vec3 heading_direction(float heading);

}  // namespace limn
