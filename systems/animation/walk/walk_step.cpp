#include "systems/animation/walk/walk_step.h"

#include "ecs/base/rotation.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.foot-flight, char.walk-cycle

namespace limn {
namespace {

constexpr float kWalkSubstep = 1.0f / 60.0f;  // longest [s]
constexpr int kMaxWalkSubsteps = 120;         // what is longer is left out
constexpr float kTurnGain = 2.5f;             // of the angle that is left to turn [1/s]
constexpr float kTurnResponse = 0.15f;        // [s]
constexpr float kFollowResponse = 0.06f;      // of the speed of a root that something moves [s]
constexpr float kPhaseGain = 6.0f;            // of the phase of hips and arms [1/s]
constexpr float kPhaseResponse = 0.04f;       // [s]
constexpr float kActivityResponse = 0.12f;    // [s]
constexpr float kAimRate = 14.0f;             // at which prints follow their plan [1/s]
constexpr float kAimLock = 0.65f;             // of a flight; then prints stay where they are
constexpr float kStandSpeed = 0.06f;          // [leg lengths/s] below it, it stands
constexpr float kTurningSpeed = 0.3f;         // above it, it steps [rad/s]
constexpr float kPrintError = 0.03f;          // of standing feet [leg lengths]
constexpr float kHeadingError = 0.12f;        // [rad]
constexpr float kSwingAround = 0.1f;          // of a stiff leg, sideways [leg lengths]
constexpr float kBehind = 0.36f;              // of a foot that leaves the ground [strides]
constexpr float kMinBehind = 0.2f;            // [leg lengths]
constexpr float kFarBehind = 0.72f;           // farthest that a leg reaches back [leg lengths],
constexpr float kGainsCloser = 0.02f;         // and less by this per acceleration [s^2/m]
constexpr float kFastestHurry = 3.0f;         // of steps, for a foot not to be left farther behind
constexpr float kHurryAhead = 0.2f;           // for which an acceleration counts [s]
constexpr float kMaxGain = 3.0f;              // acceleration that is planned for [m/s^2]
constexpr float kLeanPerPull = 0.04f;         // [rad/(m/s^2)]
constexpr float kClimbResponse = 0.25f;       // of the root on slopes and stairs [s]
constexpr float kRootJump = 0.6f;             // of a root that is placed elsewhere [leg lengths]
constexpr float kRollTime = 0.25f;            // of a foot that has landed in a run [steps]
constexpr float kKick = 0.36f;                // of heels, in a run at twice a walk [leg lengths]
constexpr float kFlightSlack = 0.3f;          // by which flying feet do not pull [leg lengths]
constexpr float kKickPitch = 0.7f;            // of a foot while its heel is high [rad]

float follow_share(float step, float response) {
    return 1 - std::exp(-step / response);
}

Vec3 flat(const Vec3& v) {
    return {v.x, 0, v.z};
}

WalkSize size_in(const WalkBody& body, const Transform& transform) {
    const float scale = uniform_scale(transform);
    return {scale * leg_length(body), {scale * body.legs[0].side, scale * body.legs[1].side}};
}

float heading_of(const WalkBody& body, const Quat& rotation) {
    const Vec3 ahead = rotation * heading_direction(body.heading);
    return std::atan2(ahead.x, ahead.z);
}

/// Everything a substep needs; the functions below are its parts.
struct WalkStep {
    const Walk& walk;
    const WalkSize& size;
    WalkMotion& motion;
    WalkState& state;
    float dt;

    [[nodiscard]] float speed() const { return glm::length(motion.velocity); }
    [[nodiscard]] WalkStride stride() const { return find_stride(walk, size.leg, motion); }
    [[nodiscard]] Footprint print_of(std::uint32_t foot) const {
        return {state.feet[foot].to, state.feet[foot].to_heading};
    }
    [[nodiscard]] Footprint home_of(std::uint32_t foot) const {
        return home_print(walk, size, foot, {motion.root, motion.heading});
    }
    [[nodiscard]] bool is_moving() const {
        const float least = kStandSpeed * size.leg;
        return speed() > least || glm::length(motion.pull) > 2 * least
               || std::abs(motion.turn) > kTurningSpeed;
    }
    /// How far a foot is from where it would stand.
    [[nodiscard]] bool is_away(std::uint32_t foot) const {
        const Footprint home = home_of(foot);
        return glm::distance(flat(home.place), flat(state.feet[foot].to)) > kPrintError * size.leg
               || std::abs(wrap_angle(home.heading - state.feet[foot].to_heading)) > kHeadingError;
    }
    /// Steps are faster where the foot on the ground would be left behind by more than a leg
    /// reaches before it is its turn to fly.
    [[nodiscard]] float hurry() const {
        const WalkFoot& stance = state.feet[1 - state.flying];
        const Vec3 ahead = motion.velocity + 0.5f * kHurryAhead * motion.gain;
        const float fast = glm::length(ahead);
        if (fast < kStandSpeed * size.leg) {
            return 1;
        }
        const float left = (1 - state.step) * duration_of(state.flying);
        const float behind = glm::dot(flat(motion.root - stance.place), ahead) / fast;
        const float far = (kFarBehind - kGainsCloser * glm::length(motion.gain)) * size.leg;
        const float room = std::max(far - behind, 1e-3f);
        return std::clamp(fast * left / room, 1.0f, kFastestHurry);
    }
    [[nodiscard]] float duration_of(std::uint32_t foot) const {
        return step_duration(walk, foot, stride().duration);
    }
    [[nodiscard]] float time_left(std::uint32_t foot) const {
        const float steps = state.step + (foot == state.flying ? 0.0f : 1.0f);
        return std::max(state.feet[foot].flight - steps, 0.0f) * duration_of(foot) / hurry();
    }
    [[nodiscard]] float rolling(std::uint32_t foot) const {
        const WalkFoot& place = state.feet[foot];
        const Vec3 ahead = heading_direction(place.to_heading);
        const float on_ground = (2 - place.flight) / (2 - kFlightShare);
        const float reference =
            std::hypot(kBehind * on_ground * stride().length, kMinBehind * size.leg);
        return toe_off_pitch(walk, foot, glm::dot(motion.root - place.to, ahead) / reference);
    }
};

/// Which foot begins.
std::uint32_t first_foot(const WalkStep& step) {
    if (std::abs(step.motion.turn) > kTurningSpeed) {
        return step.motion.turn > 0 ? 0 : 1;
    }
    const auto distance = [&](std::uint32_t foot) {
        return glm::distance(step.home_of(foot).place, step.state.feet[foot].to);
    };
    return distance(0) > distance(1) + 1e-3f ? 0 : 1;
}

/// The foot of the next step after one of `last`, or none.
std::uint32_t next_foot(const WalkStep& step, std::uint32_t last) {
    const bool goes = step.is_moving();
    if (last == WalkState::kNoFoot) {
        return goes || step.is_away(0) || step.is_away(1) ? first_foot(step) : last;
    }
    const std::uint32_t other = 1 - last;
    const bool flies = step.state.feet[last].flight > 1;
    if (goes || flies || step.is_away(other)) {
        return other;
    }
    return step.is_away(last) ? last : WalkState::kNoFoot;
}

/// Heading of a print, continued from another one without full turns.
float near_heading(float heading, float like) {
    return like + wrap_angle(heading - like);
}

Footprint plan_of(const WalkStep& step, std::uint32_t foot) {
    Footprint print = plan_footprint(
        step.walk, step.size, step.motion, foot, step.time_left(foot), step.print_of(1 - foot));
    print.heading = near_heading(print.heading, step.state.feet[foot].from_heading);
    return print;
}

void lift_foot(const WalkStep& step, std::uint32_t which) {
    WalkState& state = step.state;
    WalkFoot& foot = state.feet[which];
    const float pitch = step.rolling(which);
    state.flying = which;
    foot.flight =
        flight_steps(std::max(state.run, run_share(step.size.leg, speed_soon(step.motion))));
    // When it left the ground; since then a part of a substep has passed.
    const float since = state.step * step.duration_of(which);
    foot.lift_rate = (pitch - foot.pitch) / step.dt;
    foot.lift_pitch = pitch - since * foot.lift_rate;
    foot.from = foot.to;
    foot.from_heading = foot.to_heading;
    const Footprint plan = plan_of(step, which);
    foot.to = plan.place;
    foot.to_heading = plan.heading;
    foot.aim_speed = Vec3(0);
    foot.aim_turn = 0;
    // Short steps are lower, and land flat.
    const WalkStride stride = step.stride();
    const Vec3 ahead = heading_direction(step.motion.heading);
    const float forward = glm::dot(foot.to - foot.from, ahead) / std::max(stride.length, 1e-6f);
    const float usual = std::clamp(step.speed() / step.walk.speed, 0.0f, 1.0f);
    const LegWeights& weights = leg_weights(step.walk, which);
    const float far =
        std::clamp(glm::distance(foot.to, foot.from) / (1.2f * step.size.leg), 0.f, 1.f);
    foot.height = step.walk.step_height * (0.25f + 0.75f * weights.knee)
                  * (0.5f + 0.5f * std::min(std::max(far, usual), 1.0f));
    const float fast = step.speed() / (2 * max_walk_speed(step.size.leg));
    foot.height += state.run * kKick * step.size.leg * std::clamp(fast, 0.5f, 1.2f);
    foot.strike = step.walk.heel_strike * weights.ankle * usual * std::clamp(forward, 0.0f, 1.0f)
                  * (1 - 0.7f * state.run);
}

/// The print in flight follows the plan like a critically damped spring, and stops before the
/// foot lands.
void aim_print(const WalkStep& step, WalkFoot& foot, std::uint32_t which, float s) {
    const Footprint plan = plan_of(step, which);
    const bool is_locked = s > kAimLock;
    const float rate = is_locked ? 30.0f : kAimRate;
    const float force = is_locked ? 0.0f : rate * rate;
    const float dt = step.dt;
    // Implicit Euler: stable for any step.
    const float inverse = 1 / (1 + 2 * rate * dt + force * dt * dt);
    foot.aim_speed = inverse * (foot.aim_speed + dt * force * (plan.place - foot.to));
    foot.aim_turn = inverse * (foot.aim_turn + dt * force * (plan.heading - foot.to_heading));
    foot.to += dt * foot.aim_speed;
    foot.to_heading += dt * foot.aim_turn;
}

void place_flying_foot(const WalkStep& step, std::uint32_t which, float s) {
    WalkFoot& foot = step.state.feet[which];
    const Vec2 flight = flight_point(step.walk, s);
    const float stiff = 1 - leg_weights(step.walk, which).knee;
    const Vec3 outward = (which == 0 ? 1.0f : -1.0f)
                         * glm::cross(Vec3(0, 1, 0), heading_direction(step.motion.heading));
    const float around = stiff * kSwingAround * step.size.leg * square(std::sin(kPi * s));
    foot.place = glm::mix(foot.from, foot.to, flight.x) + around * outward;
    const float run = (foot.flight - kFlightShare) / (kRunFlight - kFlightShare);
    foot.place.y += foot.height * glm::mix(flight.y, kick_height(s), run);
    foot.heading = glm::mix(foot.from_heading, foot.to_heading, flight.x);
    const float duration = foot.flight * step.duration_of(which);
    foot.pitch = flight_pitch(foot.lift_pitch, foot.lift_rate, foot.strike, s, duration)
                 - run * kKickPitch * kick_height(s);
}

void place_standing_foot(const WalkStep& step, std::uint32_t which) {
    WalkFoot& foot = step.state.feet[which];
    foot.place = foot.to;
    foot.heading = foot.to_heading;
    foot.pitch = step.rolling(which);
    if (step.state.flying == WalkState::kNoFoot) {
        return;
    }
    const float since = step.state.step + (which == step.state.flying ? 0.0f : 1.0f) - foot.flight;
    const float roll_time = foot.flight < 1 ? 1 - foot.flight : kRollTime;
    if (since < roll_time) {  // it has just landed
        foot.pitch += landing_pitch(foot.strike - foot.pitch, since / roll_time);
    }
}

/// Begins, continues or ends steps.
void step_feet(const WalkStep& step) {
    WalkState& state = step.state;
    if (state.flying == WalkState::kNoFoot) {
        const std::uint32_t foot = next_foot(step, WalkState::kNoFoot);
        if (foot != WalkState::kNoFoot) {
            state.step = 0;
            lift_foot(step, foot);
        }
    } else {
        state.step +=
            step.dt * step.hurry() / step_duration(step.walk, state.flying, step.stride().duration);
        if (state.step >= 1) {
            const std::uint32_t foot = next_foot(step, state.flying);
            const float more = (state.step - 1) * step.duration_of(state.flying);
            state.step =
                foot == WalkState::kNoFoot ? 1.0f : std::min(more / step.duration_of(foot), 0.5f);
            state.flying = foot;
            if (foot != WalkState::kNoFoot) {
                lift_foot(step, foot);
            }
        }
    }
    for (std::uint32_t foot = 0; foot < 2; ++foot) {
        const float s = flight_progress(state, foot);
        if (s < 1) {
            aim_print(step, state.feet[foot], foot, s);
            place_flying_foot(step, foot, s);
        } else {
            place_standing_foot(step, foot);
        }
    }
}

/// Velocity and heading that the intent asks for.
void want_motion(
    const Walk& walk, const MoveIntent& intent, float leg, WalkMotion& motion, float dt) {
    constexpr float kAnySpeed = 1e3f;
    Vec3 wanted = is_finite(intent.velocity)
                      ? glm::clamp(flat(intent.velocity), Vec3(-kAnySpeed), Vec3(kAnySpeed))
                      : Vec3(0);
    const float speed = glm::length(wanted);
    const Vec3 facing = is_finite(intent.facing) ? flat(intent.facing) : Vec3(0);
    const bool strafes = glm::length(facing) > 1e-3f;
    const float most =
        max_walk_speed(leg) * (strafes ? stride_stretch(wanted, motion.heading) : 1.0f);
    wanted *= speed > most ? most / speed : 1.0f;
    const Vec3 toward = strafes ? facing : wanted;
    float angle = 0;
    if (strafes || speed > 0.02f * leg) {
        angle = wrap_angle(std::atan2(toward.x, toward.z) - motion.heading);
    }
    if (!strafes) {  // people go where they face
        const float ahead = std::max(std::cos(angle), 0.0f);
        wanted = ahead * ahead * glm::length(wanted) * heading_direction(motion.heading);
    }
    motion.wanted = wanted;
    const float turn = std::clamp(kTurnGain * angle, -walk.turn_speed, walk.turn_speed);
    motion.turn += follow_share(dt, kTurnResponse) * (turn - motion.turn);
}

void move_root(const Walk& walk, WalkMotion& motion, float dt) {
    const float share = follow_share(dt, walk.response);
    motion.pull += share * (motion.wanted - motion.pull);
    motion.velocity += share * (motion.pull - motion.velocity);
    motion.root += dt * motion.velocity;
    motion.heading = wrap_angle(motion.heading + dt * motion.turn);
    motion.response = walk.response;
}

/// Speed and turn of a root that something else has moved; `motion.root` and `heading` are new.
void measure_root(const WalkState& before, WalkMotion& motion, float dt) {
    const Vec3 velocity = flat(motion.root - before.root) / dt;
    const float turn = wrap_angle(motion.heading - before.heading) / dt;
    const float share = follow_share(dt, kFollowResponse);
    motion.pull += share * (velocity - motion.pull);
    motion.velocity += share * (motion.pull - motion.velocity);
    motion.turn += share * (turn - motion.turn);
    motion.wanted = motion.pull;
    motion.response = 0;
    motion.gain = (motion.pull - motion.velocity) / kFollowResponse;
    const float size = glm::length(motion.gain);
    motion.gain *= size > kMaxGain ? kMaxGain / size : 1.0f;
}

/// Phase and amplitudes of hips, spine and arms.
void step_sway(const WalkStep& step) {
    WalkState& state = step.state;
    const bool steps = state.flying != WalkState::kNoFoot;
    const float share = follow_share(step.dt, kActivityResponse);
    state.activity_aim += share * ((steps ? 1.0f : 0.0f) - state.activity_aim);
    state.activity += share * (state.activity_aim - state.activity);
    state.vigor += share * (step.speed() / step.walk.speed - state.vigor);
    state.run += share * (run_share(step.size.leg, speed_soon(step.motion)) - state.run);
    float rate = 0;
    if (steps) {
        rate = kPi / step.duration_of(state.flying);
        const float phase = kPi * (state.step + static_cast<float>(state.flying));
        if (state.activity < 0.02f) {  // unseen
            state.phase = phase;
        }
        rate += kPhaseGain * wrap_angle(phase - state.phase);
    }
    state.phase_rate += follow_share(step.dt, kPhaseResponse) * (rate - state.phase_rate);
    state.phase = wrap_angle(state.phase + step.dt * state.phase_rate);
    const Vec3 ahead = heading_direction(step.motion.heading);
    const float gain =
        glm::dot(step.motion.pull - step.motion.velocity, ahead) / step.walk.response;
    const float lean = std::clamp(kLeanPerPull * gain, -0.15f, 0.15f);
    state.lean += follow_share(step.dt, 0.2f) * (lean - state.lean);
}

void write_motion(const WalkMotion& motion, WalkState& state) {
    state.root = motion.root;
    state.heading = motion.heading;
    state.velocity = motion.velocity;
    state.pull = motion.pull;
    state.turn = motion.turn;
}

void level_prints(float height, WalkState& state) {
    for (WalkFoot& foot : state.feet) {
        foot.from.y = height;
        foot.to.y = height;
    }
}

/// Of a foot in a run: 1 in the middle of its flight, 0 on the ground.
float free_share(const WalkState& state, std::uint32_t foot) {
    const float run = (state.feet[foot].flight - kFlightShare) / (kRunFlight - kFlightShare);
    const float s = std::clamp(flight_progress(state, foot), 0.0f, 1.0f);
    const float inside = std::min(5 * s * (1 - s), 1.0f);
    return run * inside * inside * (3 - 2 * inside);
}

bool is_usable(const Transform& transform) {
    const Quat& q = transform.rotation;
    return is_finite(transform.position) && std::isfinite(q.w + q.x + q.y + q.z)
           && is_finite(transform.scale);
}

}  // namespace

float uniform_scale(const Transform& transform) {
    return std::max(std::abs(finite_or(transform.scale.y, 1.0f)), 1e-6f);
}

void place_walk(
    const Walk& walk, const WalkBody& body, const Transform& transform, WalkState& state) {
    const Walk style = effective_walk(walk);
    const WalkSize size = size_in(body, transform);
    state = {};
    state.placed = 1;
    state.root = transform.position;
    state.heading = heading_of(body, transform.rotation);
    for (std::uint32_t i = 0; i < 2; ++i) {
        const Footprint home = home_print(style, size, i, {state.root, state.heading});
        WalkFoot& foot = state.feet[i];
        foot.from = foot.to = foot.place = home.place;
        foot.from_heading = foot.to_heading = foot.heading = home.heading;
    }
}

void step_walk(
    const Walk& walk, const MoveIntent& intent, const WalkBody& body, std::optional<float> lift,
    float step, WalkState& state, Transform& transform) {
    if (!body.can_walk || !is_usable(transform)) {
        return;
    }
    const WalkSize size = size_in(body, transform);
    const Walk style = effective_walk(walk);
    const float time = std::isfinite(step) ? std::max(step, 0.0f) : 0.0f;
    const float most = 2 * max_walk_speed(size.leg) * time + kRootJump * size.leg;
    if (state.placed == 0 || glm::distance(state.root, transform.position) > most) {
        place_walk(walk, body, transform, state);
    }
    const int count =
        std::min(static_cast<int>(std::ceil(time / kWalkSubstep - 1e-3f)), kMaxWalkSubsteps);
    const float dt =
        count > 0 ? std::min(time, kMaxWalkSubsteps * kWalkSubstep) / static_cast<float>(count)
                  : 0.0f;
    const Vec3 begin = style.moves_root ? transform.position : state.root;
    const float turned = wrap_angle(heading_of(body, transform.rotation) - state.heading);
    const float begin_heading = state.heading + (style.moves_root ? turned : 0.0f);
    WalkMotion motion = {
        .root = begin,
        .heading = begin_heading,
        .velocity = state.velocity,
        .pull = state.pull,
        .wanted = state.pull,
        .turn = state.turn,
        .response = 0};
    for (int i = 0; i < count; ++i) {
        if (style.moves_root) {
            want_motion(style, intent, size.leg, motion, dt);
            motion.root.y += follow_share(dt, kClimbResponse) * lift.value_or(0.0f);
            move_root(style, motion, dt);
        } else {
            const float share = static_cast<float>(i + 1) / static_cast<float>(count);
            motion.root = glm::mix(begin, transform.position, share);
            motion.heading = wrap_angle(begin_heading + share * turned);
            measure_root(state, motion, dt);
        }
        if (lift) {
            level_prints(motion.root.y, state);
        }
        const WalkStep substep = {style, size, motion, state, dt};
        step_feet(substep);
        step_sway(substep);
        write_motion(motion, state);
    }
    if (style.moves_root && count > 0) {
        transform.position = motion.root;
        transform.rotation = normalize_or_identity(
            rotation_about({0, 1, 0}, wrap_angle(motion.heading - body.heading)));
    }
}

WalkTargets
find_walk_targets(const WalkBody& body, const WalkState& state, const Transform& transform) {
    WalkTargets targets;
    const Quat back = glm::conjugate(transform.rotation);
    const float inverse = 1 / uniform_scale(transform);
    const float heading = heading_of(body, transform.rotation);
    for (std::uint32_t i = 0; i < 2; ++i) {
        const WalkFoot& foot = state.feet[i];
        targets.places[i] = inverse * (back * (foot.place - transform.position));
        targets.headings[i] = wrap_angle(foot.heading - heading);
        targets.pitches[i] = foot.pitch;
        targets.slack[i] = kFlightSlack * free_share(state, i);
        targets.limp[i] = free_share(state, i);
    }
    targets.forward = heading_direction(body.heading);
    targets.left = glm::cross(Vec3(0, 1, 0), targets.forward);
    return targets;
}

}  // namespace limn
