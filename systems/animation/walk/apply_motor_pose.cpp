#include "systems/animation/walk/apply_motor_pose.h"

#include "ecs/base/gravity.h"
#include "ecs/base/rotation.h"
#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/ik/pose_ik.h"
#include "systems/animation/ik/shoulder_girdle.h"
#include "systems/animation/walk/walk_plan.h"
#include "systems/animation/walk/walk_pose.h"
#include "systems/animation/walk/walk_step.h"
#include "systems/characters/ground_ride.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.motion-select

namespace limn {
namespace {

constexpr float kWeightRate = 14.0f;     // of most weights [1/s]
constexpr float kSlowRate = 6.0f;        // of weights in water and of throws [1/s]
constexpr float kTrailRate = 18.0f;      // at which feet follow a body off the ground [1/s]
constexpr float kSwimTrailRate = 16.0f;  // likewise in water [1/s]
constexpr float kSettleRate = 24.0f;     // of feet that have just landed [1/s]
constexpr float kRunningCrouch = 0.35f;  // of the crouch before a jump, in a run
constexpr float kCrouchRate = 30.0f;     // [1/s]
constexpr float kStretchRate = 22.0f;    // of the hips after a take-off [1/s]
constexpr float kFastAir = 4.0f;         // speed at which strides in the air are widest [m/s]
constexpr float kLandTime = 0.36f;       // before a landing, when legs stretch for the ground [s]
constexpr float kLandRate = 12.0f;       // at which they do [1/s]
constexpr auto kFallGravity = static_cast<float>(kGravity);  // [m/s^2]
constexpr float kWadeAt = 0.2f;       // depth relative to the height at which it wades
constexpr float kWadeFull = 0.55f;    // depth at which it does so fully
constexpr float kCruiseSpeed = 0.6f;  // at which it lies in the water [m/s]
constexpr float kHipsBelow = 0.34f;   // depth of its hips then [leg lengths]
constexpr float kDive = 1.2f;         // by which it lies [rad]
constexpr float kArch = 0.3f;         // of its back in a stroke [rad],
constexpr float kHeadBack = 0.3f;     // and of its neck: it looks ahead
constexpr float kPull = 0.4f;         // of a stroke, until arms have pulled
constexpr float kRecover = 0.6f;      // and until hands and feet are drawn up
constexpr float kRunStep = 0.36f;     // duration of a step of a run, of sqrt(leg / 1 m) [s]
constexpr float kPalm = 0.05f;        // from the wrist to what hands hold [m]

float smooth01(float t) {
    const float s = std::clamp(t, 0.0f, 1.0f);
    return s * s * (3 - 2 * s);
}

Vec3 flat_part(const Vec3& v) {
    return {v.x, 0, v.z};
}

/// Parts of a breast stroke at `phase`, 0 .. 1: arms pull, hands and feet are drawn up, both
/// stretch and glide.
struct Stroke {
    float pull = 0.0f;  ///< 0 stretched, 1 hands beside the chest
    float tuck = 0.0f;  ///< 0 stretched, 1 feet drawn up
    float wide = 0.0f;  ///< of arms, sideways
    float kick = 0.0f;  ///< of feet, sideways
};

Stroke find_stroke(float phase) {
    Stroke stroke;
    stroke.pull = smooth01(phase / kPull) * (1 - smooth01((phase - kRecover) / 0.2f));
    stroke.tuck = smooth01((phase - 0.34f) / 0.2f) * (1 - smooth01((phase - 0.54f) / 0.14f));
    stroke.wide = smooth01(phase / 0.2f) * (1 - smooth01((phase - 0.3f) / 0.25f));
    stroke.kick = smooth01((phase - 0.45f) / 0.12f) * (1 - smooth01((phase - 0.58f) / 0.16f));
    return stroke;
}

/// How far hands reach down to what it picks up: 0 .. 1.
float stoop_of(const MotorPoseState& state, const WalkBody& body) {
    const float hands = 0.5f * (state.hands[0].y + state.hands[1].y);
    return state.hold.value * smooth01((1.05f * body.hips_place.y - hands) / body.hips_place.y);
}

/// Where a foot off the ground should be, in the character's space: place as in WalkFoot.
struct FreeFoot {
    Vec3 place = {0, 0, 0};
    float pitch = 0.0f;
};

FreeFoot mix_feet(const FreeFoot& a, const FreeFoot& b, float share) {
    return {glm::mix(a.place, b.place, share), glm::mix(a.pitch, b.pitch, share)};
}

/// The place that puts the ankle at `ankle`.
FreeFoot foot_at_ankle(const WalkLeg& leg, const Vec3& ankle, float pitch) {
    const FootPlace foot = find_foot_place(leg, Vec3(0), 0, pitch);
    return {ankle - foot.ankle, pitch};
}

struct BodyFrame {
    Vec3 left;
    Vec3 forward;
    Quat turn = {1, 0, 0, 0};  ///< of the hips by swimming
    Vec3 shift = {0, 0, 0};    ///< of the hips [m]
};

BodyFrame find_frame(const MotorPoseState& state, const WalkBody& body) {
    BodyFrame frame;
    frame.forward = heading_direction(body.heading);
    frame.left = glm::cross(Vec3(0, 1, 0), frame.forward);
    const float lies = state.swim.value * state.cruise.value;
    const float leg = leg_length(body);
    frame.turn =
        rotation_about(frame.left, state.swim.value * glm::mix(0.22f, kDive, state.cruise.value));
    const float wanted = state.water - kHipsBelow * leg;
    frame.shift = lies * (Vec3(0, wanted - body.hips_place.y, 0) - 0.45f * leg * frame.forward);
    return frame;
}

FreeFoot jumping_foot(
    const MotorPose& style, const MotorPoseState& state, const WalkBody& body, std::uint32_t which,
    float speed) {
    const WalkLeg& leg = body.legs[which];
    const BodyFrame frame = find_frame(state, body);
    const float length = leg_length(body);
    const float fast = std::clamp(speed / kFastAir, 0.0f, 1.0f);
    const bool leads = which == state.lead;
    const Vec3 side = 0.9f * leg.side * frame.left;
    const float stride = leads ? 0.06f + 0.38f * fast : -0.1f - 0.34f * fast;
    const float height = style.tuck * (leads ? 0.62f + 0.38f * fast : 0.5f);
    const FreeFoot rising = {
        side + length * (stride * frame.forward + Vec3(0, height, 0)),
        leads ? -0.35f : -0.6f - 0.4f * fast};
    const float reach = leads ? 0.06f + 0.2f * fast : -0.03f - 0.1f * fast;
    const FreeFoot falling = {side + length * reach * frame.forward, leads ? 0.0f : -0.15f};
    return mix_feet(rising, falling, state.fall.value);
}

FreeFoot swimming_foot(const MotorPoseState& state, const WalkBody& body, std::uint32_t which) {
    const WalkLeg& leg = body.legs[which];
    const BodyFrame frame = find_frame(state, body);
    const float length = leg_length(body);
    const float sign = which == 0 ? 1.0f : -1.0f;
    const Stroke stroke = find_stroke(state.phase);
    const Vec3 back = frame.turn * Vec3(0, -1, 0);
    const Vec3 belly = frame.turn * frame.forward;
    const Vec3 socket = body.hips_place + frame.shift + frame.turn * leg.socket;
    const float straight = glm::mix(0.99f, 0.55f, stroke.tuck);
    const Vec3 frog = socket
                      + length
                            * (straight * back + 0.12f * stroke.tuck * belly
                               + sign * (0.1f * stroke.tuck + 0.26f * stroke.kick) * frame.left);
    const float turn = 2 * kPi * (state.phase + 0.5f * static_cast<float>(which));
    const Vec3 tread = socket
                       + length
                             * ((0.86f + 0.07f * std::sin(turn)) * back
                                + 0.16f * std::cos(turn) * belly + sign * 0.12f * frame.left);
    const FreeFoot cruising =
        foot_at_ankle(leg, frog, glm::mix(-2.4f, -1.3f, stroke.tuck + stroke.kick));
    return mix_feet(foot_at_ankle(leg, tread, -0.8f), cruising, state.cruise.value);
}

/// Feet move with the body, and after it.
void step_free_feet(
    const MotorPose& style, const MotorPoseInput& input, const WalkBody& body,
    const Transform& transform, float step, MotorPoseState& state, WalkState& walk) {
    const float scale = uniform_scale(transform);
    const float speed = glm::length(flat_part(input.velocity));
    const bool swims = input.motor.mode == MotorMode::Swim;
    const float rate = swims ? kSwimTrailRate : kTrailRate;
    const float inverse = 1 / (1 + 2 * rate * step + square(rate * step));
    const Vec3 moved = transform.position - state.root;
    for (std::uint32_t i = 0; i < 2; ++i) {
        WalkFoot& foot = walk.feet[i];
        const FreeFoot jumping = jumping_foot(style, state, body, i, speed / scale);
        const FreeFoot free = mix_feet(jumping, swimming_foot(state, body, i), state.swim.value);
        const Vec3 target = scale * (transform.rotation * free.place);
        Vec3 offset = foot.place + moved - transform.position;  // as if it moved with the root
        if (state.off_ground == 0) {  // it leaves the ground: its place stays, the root moves on
            offset = foot.place - state.root;
            foot.aim_speed -= input.velocity;
        }
        foot.aim_speed = inverse * (foot.aim_speed + step * rate * rate * (target - offset));
        offset += step * foot.aim_speed;
        foot.aim_turn = inverse * (foot.aim_turn + step * rate * rate * (free.pitch - foot.pitch));
        foot.pitch += step * foot.aim_turn;
        foot.place = transform.position + offset;
        foot.heading = walk.heading;
    }
}

/// Feet stand where they are. In a run only the one ahead does: the other is in flight already.
void plant_free_feet(
    const MotorPoseInput& input, const WalkBody& body, const Transform& transform,
    MotorPoseState& state, WalkState& walk) {
    const float scale = uniform_scale(transform);
    const float leg = scale * leg_length(body);
    const Vec3 velocity = flat_part(input.velocity);
    const float run = run_share(leg, glm::length(velocity));
    const bool runs = run > 0.3f;
    const std::uint32_t trail = 1 - std::min(state.lead, 1u);
    walk.flying = runs ? trail : WalkState::kNoFoot;
    walk.step = runs ? flight_steps(run) - 1 : 1;
    for (std::uint32_t i = 0; i < 2; ++i) {
        WalkFoot& foot = walk.feet[i];
        const float lift = foot.place.y - transform.position.y;
        state.lifts[i] = lift;
        state.tilts[i] = foot.pitch;
        foot.place.y = transform.position.y;
        foot.from = foot.to = foot.place;
        foot.from_heading = foot.to_heading = foot.heading;
        foot.pitch = foot.lift_pitch = foot.lift_rate = foot.strike = 0;
        foot.flight = kFlightShare;
        foot.aim_speed = Vec3(0);
        foot.aim_turn = 0;
        if (runs && i == trail) {
            // The flight that passes through where it is.
            foot.flight = flight_steps(run);
            const float steps = foot.flight - walk.step;
            foot.to += (kRunStep * std::sqrt(leg) * steps) * velocity;
            const float s = flight_progress(walk, i);
            const float share = flight_point({}, s).x;
            foot.from += (foot.place - foot.to) * (share / (1 - share));
            foot.height = std::max(lift / kick_height(s), 0.0f);
            foot.place.y += std::max(lift, 0.0f);
            state.lifts[i] = std::min(lift, 0.0f);
        }
    }
}

float heading_in(const WalkBody& body, const Quat& rotation) {
    const Vec3 ahead = rotation * heading_direction(body.heading);
    return std::atan2(ahead.x, ahead.z);
}

void follow_root(
    const MotorPoseInput& input, const WalkBody& body, const Transform& transform, float step,
    WalkState& walk) {
    walk.root = transform.position;
    walk.heading = heading_in(body, transform.rotation);
    walk.velocity = flat_part(input.velocity);
    walk.pull = walk.velocity;
    walk.turn = 0;
    const float fade = std::exp(-8 * step);
    walk.activity *= fade;
    walk.activity_aim *= fade;
    walk.lean *= fade;
}

/// Until one that falls reaches the ground, without the resistance of the air [s].
float time_to_land(const MotorState& motor) {
    if (motor.above < 0) {
        return INFINITY;
    }
    const float rise = motor.velocity.y;
    return (rise + std::sqrt(rise * rise + 2 * kFallGravity * motor.above)) / kFallGravity;
}

void step_weights(
    const MotorPose& style, const MotorPoseInput& input, float step, MotorPoseState& state) {
    const MotorState& motor = input.motor;
    const bool swims = motor.mode == MotorMode::Swim;
    const bool falls = motor.mode == MotorMode::Fall;
    const float speed = glm::length(flat_part(input.velocity));
    ease(falls ? 1.0f : 0.0f, kWeightRate, step, state.air);
    const bool drops = falls && time_to_land(motor) < kLandTime;
    ease(drops ? 1.0f : 0.0f, falls ? kLandRate : 3.0f, step, state.fall);
    ease(swims ? 1.0f : 0.0f, kSlowRate, step, state.swim);
    ease(swims ? smooth01(speed / kCruiseSpeed) : 0.0f, 3, step, state.cruise);
    const float deep = motor.depth / std::max(input.height, 1e-3f);
    const float wade = smooth01((deep - kWadeAt) / (kWadeFull - kWadeAt));
    ease(swims ? 0.0f : wade, kSlowRate, step, state.wade);
    ease(input.pushed && !input.carried ? 1.0f : 0.0f, kWeightRate, step, state.push);
    ease(input.carried ? 1.0f : 0.0f, kWeightRate, step, state.hold);
    if (state.holds != 0 && !input.carried) {  // thrown
        state.fling.rate += 40;
    }
    state.holds = input.carried ? 1 : 0;
    ease(0, kSlowRate * 1.6f, step, state.fling);
    const bool gathers = motor.gather > 0;
    const float stand = falls ? 0.0f : 0.07f * state.push.value + 0.02f * state.hold.value;
    state.water = glm::mix(state.water, std::max(motor.depth, 0.0f), 1 - std::exp(-10 * step));
    const float rate = gathers ? kCrouchRate : state.off_ground != 0 ? kStretchRate : 0.0f;
    if (rate > 0) {
        const float crouch =
            style.crouch * glm::mix(1.0f, kRunningCrouch, std::min(speed / kFastAir, 1.0f));
        ease(gathers ? crouch : stand, rate, step, state.sink);
    }
}

void step_hands(
    const MotorPoseInput& input, const WalkBody& body, float step, MotorPoseState& state) {
    const BodyFrame frame = find_frame(state, body);
    const bool holds = input.carried.has_value();
    if (!holds && !input.pushed) {
        return;
    }
    const Vec3 center = holds ? *input.carried : *input.pushed;
    const float share = state.push.value + state.hold.value > 0.05f ? 1 - std::exp(-20 * step) : 1;
    for (std::size_t i = 0; i < 2; ++i) {
        const float sign = i == 0 ? 1.0f : -1.0f;
        const float aside = holds ? 0.9f * input.width + kPalm : std::min(0.8f * input.width, 0.2f);
        Vec3 hand = center + sign * aside * frame.left;
        hand -= (holds ? 0.35f * input.width + 0.04f : kPalm + 0.05f) * frame.forward;
        hand.y -= holds ? 0.35f * input.width : 0.0f;
        state.hands[i] = glm::mix(state.hands[i], hand, share);
    }
}

/// Directions of an arm, from shoulder to elbow and from elbow to wrist.
struct ArmWays {
    Vec3 upper = {0, -1, 0};
    Vec3 fore = {0, -1, 0};
};

/// An arm at angles forward and aside from hanging [rad], with a bent elbow, in a frame.
ArmWays
arm_at(const BodyFrame& frame, float sign, float forward, float aside, float bend, float inward) {
    const auto way = [&](float pitch, float out) {
        return std::cos(out) * (std::sin(pitch) * frame.forward - std::cos(pitch) * Vec3(0, 1, 0))
               + sign * std::sin(out) * frame.left;
    };
    return {way(forward, aside), way(forward + bend, aside - inward)};
}

ArmWays turned(const Quat& turn, const ArmWays& arm) {
    return {turn * arm.upper, turn * arm.fore};
}

/// `sum` is weighted: its length is up to `weight`.
void mix_arm(const ArmWays& arm, float share, ArmWays& sum, float& weight) {
    const float s = std::clamp(share, 0.0f, 1.0f);
    sum.upper = glm::mix(sum.upper, arm.upper, s);
    sum.fore = glm::mix(sum.fore, arm.fore, s);
    weight += (1 - weight) * s;
}

ArmWays swimming_arm(const MotorPoseState& state, const BodyFrame& frame, float sign) {
    const Stroke stroke = find_stroke(state.phase);
    // Overhead is ahead; the pull goes outward and down to the chest.
    const float forward = glm::mix(2.9f, 1.1f, stroke.pull);
    const ArmWays cruise = arm_at(
        frame, sign, forward, 0.12f + 0.75f * stroke.wide + 0.2f * stroke.pull,
        1.7f * stroke.pull * (1 - 0.6f * stroke.wide), 0.3f * stroke.pull);
    const float scull = std::sin(2 * kPi * state.phase);
    const ArmWays tread = arm_at(frame, sign, 0.7f, 0.75f + 0.25f * scull, 0.55f, 0.5f * scull);
    const float share = state.cruise.value;
    const ArmWays mixed = {
        normalize_or(glm::mix(tread.upper, cruise.upper, share), cruise.upper),
        normalize_or(glm::mix(tread.fore, cruise.fore, share), cruise.fore)};
    return turned(frame.turn, mixed);
}

void apply_arm(
    const SkeletonData& skeleton, const WalkArm& arm, const ArmWays& sum, float weight,
    LocalPose& pose) {
    const ArmWays ways = {
        normalize_or(sum.upper, arm.upper_way), normalize_or(sum.fore, arm.fore_way)};
    const Quat upper_turn = rotation_between(arm.upper_way, ways.upper);
    const Quat fore_turn = rotation_between(upper_turn * arm.fore_way, ways.fore) * upper_turn;
    const Quat upper = find_place(skeleton, skeleton.rest, arm.upper).rotation;
    const Quat fore = find_place(skeleton, skeleton.rest, arm.fore).rotation;
    set_joint_rotation(skeleton, arm.upper, upper_turn * upper, weight, pose);
    set_joint_rotation(skeleton, arm.fore, fore_turn * fore, weight, pose);
    raise_collar(skeleton, {arm.collar, arm.upper, arm.fore}, weight, pose);
}

/// Turns a joint back about an axis in the character's space.
void bend_joint(
    const SkeletonData& skeleton, std::uint16_t joint, const Vec3& left, float angle,
    LocalPose& pose) {
    if (joint < pose.size() && angle > 1e-4f) {
        const Quat now = find_place(skeleton, pose, joint).rotation;
        set_joint_rotation(skeleton, joint, rotation_about(left, -angle) * now, 1, pose);
    }
}

void reach_with_hand(
    const SkeletonData& skeleton, const MotorPoseState& state, const WalkBody& body,
    std::size_t side, float weight, LocalPose& pose) {
    const BodyFrame frame = find_frame(state, body);
    const float sign = side == 0 ? 1.0f : -1.0f;
    const WalkArm& arm = body.arms[side];
    const LimbReach reach = {
        .target = state.hands[side],
        .options =
            {.pole = Vec3(0, -0.8f, 0) + 0.7f * sign * frame.left - 0.3f * frame.forward,
             .softness = 0.02f * leg_length(body)},
        .weight = weight};
    reach_with_arm(skeleton, arm.collar, {arm.upper, arm.fore, arm.hand}, reach, pose);
}

}  // namespace

void ease(float target, float rate, float step, EasedValue& eased) {
    const float inverse = 1 / (1 + 2 * rate * step + square(rate * step));
    eased.rate = inverse * (eased.rate + step * rate * rate * (target - eased.value));
    eased.value += step * eased.rate;
}

void step_motor_pose(
    const MotorPose& style, const MotorPoseInput& input, const WalkBody& body,
    const Transform& transform, float step, MotorPoseState& state, WalkState& walk) {
    if (!body.can_walk || walk.placed == 0 || !(step > 0) || !is_finite(input.velocity)) {
        return;
    }
    const float leg = uniform_scale(transform) * leg_length(body);
    const bool stands = input.motor.mode == MotorMode::Stand;
    const float stroke = glm::mix(0.6f, 1.0f, state.cruise.value) * style.stroke;
    state.phase += step * stroke;
    state.phase -= std::floor(state.phase);
    step_weights(style, input, step, state);
    step_hands(input, body, step, state);
    const float settle = std::exp(-kSettleRate * step);
    for (std::size_t i = 0; i < 2; ++i) {
        state.lifts[i] *= settle;
        state.tilts[i] *= settle;
    }
    if (!stands) {
        if (state.off_ground == 0) {
            state.root = carry_point(input.motor.ride, state.root);
            const bool left_flies = walk.flying == 0 && flight_progress(walk, 0) < 1;
            const Vec3 between = walk.feet[0].place - walk.feet[1].place;
            const bool left_ahead =
                glm::dot(between, heading_direction(walk.heading)) > 0.02f * leg;
            state.lead = left_flies || left_ahead ? 0 : 1;
            state.phase = 0.9f;
            for (WalkFoot& foot : walk.feet) {
                foot.aim_speed = Vec3(0);
                foot.aim_turn = 0;
            }
        }
        step_free_feet(style, input, body, transform, step, state, walk);
        follow_root(input, body, transform, step, walk);
        state.drop_speed = std::max(-input.velocity.y, 0.0f);
        state.off_ground = 1;
    } else {
        if (state.off_ground != 0) {
            state.sink.rate += state.drop_speed / leg;
            plant_free_feet(input, body, transform, state, walk);
            follow_root(input, body, transform, step, walk);
            state.off_ground = 0;
        }
        if (!(input.motor.gather > 0)) {
            const float held = 0.06f * state.push.value + 0.02f * state.hold.value;
            ease(held, style.give, step, state.sink);
        }
    }
    state.root = transform.position;
}

void add_motor_targets(const MotorPose& style, const MotorPoseState& state, WalkBody& body) {
    const BodyFrame frame = find_frame(state, body);
    WalkTargets& targets = body.targets;
    const float leg = leg_length(body);
    const float most = std::max(style.deepest, 1e-3f);
    const float sink = state.sink.value > 0 ? most * (1 - std::exp(-state.sink.value / most))
                                            : 0.3f * state.sink.value;
    targets.turn = frame.turn;
    targets.shift = frame.shift - Vec3(0, leg * sink, 0);
    const float stoop = stoop_of(state, body);
    targets.shift.y -= 0.3f * leg * stoop;
    // The weight stays above the feet: hips go back as the back leans.
    const float back = 0.3f * std::max(sink, 0.0f) + 0.1f * state.push.value + 0.25f * stoop;
    targets.shift -= leg * back * frame.forward;
    targets.lean = 1.5f * std::max(sink, 0.0f) + 0.45f * state.push.value - 0.06f * state.hold.value
                   + 0.12f * state.wade.value + 0.3f * state.fling.value + 1.1f * stoop
                   + state.air.value * glm::mix(0.1f, 0.02f, state.fall.value);
    const float free = std::max(state.air.value, state.swim.value);
    for (std::size_t i = 0; i < 2; ++i) {
        targets.places[i].y += state.lifts[i];
        targets.pitches[i] += state.tilts[i];
        targets.limp[i] = std::max(targets.limp[i], std::clamp(free, 0.0f, 1.0f));
        targets.slack[i] =
            std::max(targets.slack[i], 0.5f * std::clamp(state.swim.value, 0.f, 1.f));
    }
}

void apply_motor_pose(
    const SkeletonData& skeleton, const MotorPose& style, const MotorPoseState& state,
    const WalkBody& body, LocalPose& pose) {
    if (!body.can_walk) {
        return;
    }
    const BodyFrame frame = find_frame(state, body);
    // A swimmer's back is hollow, and more so as the arms pull, so that the face is out of the
    // water.
    const float lies = std::clamp(state.swim.value * state.cruise.value, 0.0f, 1.0f);
    const float arch = lies * kArch * (0.7f + 0.3f * find_stroke(state.phase).pull);
    bend_joint(skeleton, body.chest, frame.left, arch, pose);
    bend_joint(skeleton, body.head, frame.left, lies * kHeadBack, pose);
    const float amount = std::clamp(style.arms, 0.0f, 1.0f);
    const float sink = std::clamp(2.2f * state.sink.value, 0.0f, 1.0f);
    for (std::size_t i = 0; i < 2; ++i) {
        const WalkArm& arm = body.arms[i];
        if (arm.upper == 0xffff || arm.hand == 0xffff) {
            continue;
        }
        const float sign = i == 0 ? 1.0f : -1.0f;
        const bool leads = i == state.lead;
        ArmWays ways = {Vec3(0), Vec3(0)};
        float weight = 0;
        // Landing: they come down beside the body; before a jump they are behind it.
        const float landed = std::clamp(std::max(state.fall.value, state.air.value), 0.0f, 1.0f);
        const float back = glm::mix(-0.55f, 0.2f, landed);
        mix_arm(arm_at(frame, sign, back, 0.35f, 0.7f, 0.1f), sink, ways, weight);
        // Rising they swing up, the one opposite to the leg ahead most; falling they spread.
        const ArmWays rise = arm_at(frame, sign, leads ? 0.5f : 1.25f, 0.35f, 0.9f, 0.2f);
        const ArmWays drop = arm_at(frame, sign, 0.35f, 1.0f, 0.5f, 0.25f);
        const float fall = std::clamp(state.fall.value, 0.0f, 1.0f);
        const ArmWays air = {
            normalize_or(glm::mix(rise.upper, drop.upper, fall), drop.upper),
            normalize_or(glm::mix(rise.fore, drop.fore, fall), drop.fore)};
        mix_arm(air, 0.85f * state.air.value, ways, weight);
        const float sway = 0.15f * std::sin(2 * kPi * state.phase);
        mix_arm(
            arm_at(frame, sign, 0.45f + sign * sway, 0.75f, 0.95f, 0.2f), state.wade.value, ways,
            weight);
        mix_arm(swimming_arm(state, frame, sign), state.swim.value, ways, weight);
        mix_arm(arm_at(frame, sign, 1.75f, 0.12f, 0.15f, 0.1f), state.fling.value, ways, weight);
        if (weight * amount > 1e-4f) {
            apply_arm(skeleton, arm, ways, weight * amount, pose);
        }
        const float reach = amount * std::clamp(state.push.value + state.hold.value, 0.0f, 1.0f);
        if (reach > 1e-4f) {
            reach_with_hand(skeleton, state, body, i, reach, pose);
        }
    }
}

}  // namespace limn
