#include "systems/animation/walk/walk_pose.h"

#include "ecs/base/rotation.h"
#include "systems/animation/ik/elbow_circle.h"
#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/ik/pose_ik.h"
#include "systems/animation/walk/walk_plan.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

// Techniques: char.walk-control, char.walk-cycle

namespace limn {
namespace {

constexpr std::uint16_t kNoPart = 0xffff;
constexpr float kLongest = 0.997f;        // of a leg, which never is quite straight
constexpr float kHipsSoftness = 0.006f;   // of the highest hips [leg lengths]
constexpr float kReachSoftness = 0.002f;  // of a leg out of reach [leg lengths]
constexpr float kChestShare = 0.8f;       // of the turn of the hips that the chest makes back
constexpr float kArmAside = 0.1f;         // [rad]
constexpr float kElbow = 0.28f;           // bend of elbows [rad]
constexpr float kElbowSwing = 0.22f;      // more of it forward [rad]
constexpr float kHeadLevel = 0.8f;        // share of the trunk's turns that the head makes back
// Of runs:
constexpr float kRunSink = 0.08f;      // of the hips [leg lengths]
constexpr float kRunBob = 0.03f;       // amplitude of the hips, highest in flight [leg lengths]
constexpr float kRunLean = 0.2f;       // of the back [rad]
constexpr float kRunSoftness = 0.05f;  // of the highest hips [leg lengths]
constexpr float kRunElbow = 1.45f;     // bend of elbows [rad]
constexpr float kRunArm = 0.35f;       // more amplitude of the arms [rad]

/// Periodic parts of a pose [rad], [m].
struct BodySwing {
    float yaw = 0.0f;   ///< of the hips, about +y
    float roll = 0.0f;  ///< of the hips, left side up
    float side = 0.0f;  ///< of the hips, to the left
    float up = 0.0f;
    float arm = 0.0f;   ///< of the left arm, forward
    float lean = 0.0f;  ///< of the back, forward
    float over = 0.0f;  ///< of the chest, to the left
    float run = 0.0f;   ///< 0 walks, 1 runs
};

float weakness(const LegWeights& weights) {
    return 1 - std::min({weights.hip, weights.knee, weights.ankle});
}

/// Grows by at most 0.4 beyond the comfortable speed.
float limit_vigor(float vigor) {
    return vigor < 1 ? vigor : 1.4f - 0.4f * std::exp((1 - vigor) / 0.4f);
}

BodySwing find_swing(const Walk& walk, const WalkState& state, float leg) {
    BodySwing swing;
    const float vigor = limit_vigor(state.vigor);
    const float active = state.activity;
    const float phase = state.phase;
    // Extremes: weight above the standing foot in the middle of a flight, at 0.375 of a step; legs
    // far apart when the foot has landed.
    const float over = -std::sin(phase + 0.125f * kPi);  // 1: above the left foot
    const float run = active * state.run;
    const float late = glm::mix(0.35f, 0.6f, run);
    const float apart = std::sin(phase - late * kPi);  // 1: the left leg is ahead
    const float drop = -std::sin(phase + 0.3f * kPi);
    const float weak = over > 0 ? weakness(walk.left) : weakness(walk.right);
    // Slow steps need the weight above the foot on the ground.
    const float sway = walk.sway * (1.8f - 0.8f * std::min(vigor, 1.0f)) * (1 - 0.7f * run);
    swing.side = leg * active * over * (sway + 0.03f * weak * std::abs(over));
    swing.over = active * over * (0.02f + 0.16f * weak * std::abs(over) + 0.03f * walk.tiredness);
    swing.yaw = -walk.hip_yaw * vigor * apart;
    swing.arm = -(walk.arm_swing * vigor + run * kRunArm) * apart;
    swing.run = run;
    const float stiff = drop < 0 ? 1 - walk.left.knee : 1 - walk.right.knee;
    swing.roll = active * drop * (walk.hip_roll - 0.16f * stiff * std::abs(drop));
    swing.up =
        leg * active * (walk.bob * std::cos(2 * phase - 0.75f * kPi) - 0.02f * weak * over * over);
    // Both feet fly in the first 0.45 of a step.
    swing.up += run * leg * (kRunBob * std::cos(2 * phase - 0.45f * kPi) - kRunSink);
    swing.lean = walk.stoop + state.lean + 0.03f * vigor + run * kRunLean;
    return swing;
}

struct WalkAxes {
    Vec3 left;
    Vec3 up;
    Vec3 forward;
};

/// Pitch forward, then roll left side up, then yaw.
Quat turn_by(const WalkAxes& axes, float yaw, float roll, float pitch) {
    return rotation_about(axes.up, yaw) * rotation_about(axes.forward, roll)
           * rotation_about(axes.left, pitch);
}

/// How high the hips may be for a leg to reach its ankle.
float highest_hips(
    const WalkLeg& leg, const Vec3& hips, const Quat& turn, const Vec3& ankle, float slack) {
    const Vec3 socket = turn * leg.socket;
    const Vec3 way = hips + socket - ankle;
    const float reach2 = square(kLongest * leg.length);
    const float rest = std::max(reach2 - way.x * way.x - way.z * way.z, 0.09f * reach2);
    return ankle.y + std::sqrt(rest) - socket.y + slack * leg.length;
}

void place_hips(
    const SkeletonData& skeleton, const WalkBody& body, const Vec3& place, const Quat& turn,
    LocalPose& pose) {
    const JointPlace parent = find_place(skeleton, pose, skeleton.parents[body.hips]);
    const Vec3 offset = glm::conjugate(parent.rotation) * (place - parent.position);
    pose.translations[body.hips] = offset / glm::max(glm::abs(parent.scale), Vec3(1e-6f));
    const Quat rest = find_place(skeleton, skeleton.rest, body.hips).rotation;
    set_joint_rotation(skeleton, body.hips, turn * rest, 1, pose);
}

void turn_joint(
    const SkeletonData& skeleton, std::uint16_t joint, const Quat& turn, LocalPose& pose) {
    if (joint != kNoPart) {
        const Quat now = find_place(skeleton, pose, joint).rotation;
        set_joint_rotation(skeleton, joint, turn * now, 1, pose);
    }
}

void bend_back(
    const SkeletonData& skeleton, const WalkBody& body, const WalkAxes& axes,
    const BodySwing& swing, const Quat& head, LocalPose& pose) {
    // Half of it in the lowest joint of the back, the rest in the highest.
    const float turn = -(1 + kChestShare) * swing.yaw;
    const bool has_both =
        body.chest != body.spine && body.chest != kNoPart && body.spine != kNoPart;
    const float share = has_both ? 0.5f : 1.0f;
    const Quat part =
        turn_by(axes, share * turn, share * (-swing.roll - swing.over), share * swing.lean);
    turn_joint(skeleton, body.spine != kNoPart ? body.spine : body.chest, part, pose);
    if (has_both) {
        turn_joint(skeleton, body.chest, part, pose);
    }
    if (body.head != kNoPart) {
        const Quat now = find_place(skeleton, pose, body.head).rotation;
        set_joint_rotation(skeleton, body.head, slerp(now, head, kHeadLevel), 1, pose);
    }
}

void swing_arm(
    const SkeletonData& skeleton, const WalkBody& body, const WalkAxes& axes, std::size_t side,
    float angle, float amplitude, float run, float weight, LocalPose& pose) {
    const WalkArm& arm = body.arms[side];
    if (arm.upper == kNoPart || !(weight > 0)) {
        return;
    }
    const std::uint16_t trunk = body.chest != kNoPart ? body.chest : body.hips;
    const Quat chest = find_place(skeleton, pose, trunk).rotation
                       * glm::conjugate(find_place(skeleton, skeleton.rest, trunk).rotation);
    // Arms hang, so they turn with the chest about the vertical only.
    const Vec3 ahead = chest * axes.forward;
    const float yaw = std::atan2(glm::dot(ahead, axes.left), glm::dot(ahead, axes.forward));
    const Quat about = rotation_about(axes.up, yaw);
    const float sign = side == 0 ? 1.0f : -1.0f;
    const auto hanging = [&](float forward, float aside) {
        return about
               * (std::cos(aside) * (std::sin(forward) * axes.forward - std::cos(forward) * axes.up)
                  + sign * std::sin(aside) * axes.left);
    };
    const Vec3 upper = hanging(angle, kArmAside);
    const float most = amplitude + run * kRunArm;
    const float bend =
        glm::mix(kElbow, kRunElbow, run) + kElbowSwing * (most > 1e-4f ? angle / most : 0.0f);
    const Vec3 fore = hanging(angle + bend, 0.4f * kArmAside);
    const Quat upper_turn = rotation_between(arm.upper_way, upper);
    const Quat fore_turn = rotation_between(upper_turn * arm.fore_way, fore) * upper_turn;
    const Quat upper_rest = find_place(skeleton, skeleton.rest, arm.upper).rotation;
    const Quat fore_rest = find_place(skeleton, skeleton.rest, arm.fore).rotation;
    set_joint_rotation(skeleton, arm.upper, upper_turn * upper_rest, weight, pose);
    set_joint_rotation(skeleton, arm.fore, fore_turn * fore_rest, weight, pose);
}

void place_leg(
    const SkeletonData& skeleton, const WalkLeg& leg, const FootPlace& foot, float heading,
    const WalkAxes& axes, LocalPose& pose) {
    // Knees point between the character's and the foot's directions.
    const Vec3 knee = rotation_about(axes.up, 0.5f * heading) * axes.forward;
    const LimbReach reach = {
        .target = foot.ankle,
        .options = {.pole = knee, .hinge = axes.left, .softness = kReachSoftness * leg.length}};
    reach_with_limb(skeleton, {leg.thigh, leg.shin, leg.foot}, reach, pose);
    const Quat rest = find_place(skeleton, skeleton.rest, leg.foot).rotation;
    set_joint_rotation(skeleton, leg.foot, foot.rotation * rest, 1, pose);
    if (leg.toes != kNoPart) {
        const Quat toes = find_place(skeleton, skeleton.rest, leg.toes).rotation;
        set_joint_rotation(skeleton, leg.toes, foot.toes * toes, 1, pose);
    }
}

}  // namespace

float smooth_min(float a, float b, float c, float softness) {
    const float least = std::min({a, b, c});
    const auto weight = [&](float x) { return std::exp((least - x) / softness); };
    return least - softness * std::log(weight(a) + weight(b) + weight(c));
}

FootPlace find_foot_place(const WalkLeg& leg, const Vec3& place, float heading, float pitch) {
    const Quat turn = rotation_about({0, 1, 0}, heading);
    const Quat tilted = turn * rotation_about(leg.across, -pitch);
    const Vec3 pivot = pitch < 0 ? leg.ball : leg.heel;
    FootPlace foot;
    foot.ankle = place + turn * pivot + tilted * (leg.ankle - pivot);
    foot.rotation = tilted;
    foot.toes = pitch < 0 ? turn : tilted;
    return foot;
}

void apply_walk(
    const SkeletonData& skeleton, const Walk& walk, const WalkState& state, const WalkBody& body,
    LocalPose& pose) {
    if (!body.can_walk || state.placed == 0 || body.hips >= pose.size()) {
        return;
    }
    const Walk style = effective_walk(walk);
    const WalkTargets& targets = body.targets;
    const WalkAxes axes = {targets.left, Vec3(0, 1, 0), targets.forward};
    const float length = leg_length(body);
    BodySwing swing = find_swing(style, state, length);
    swing.lean += targets.lean;
    const Quat hips = targets.turn * turn_by(axes, swing.yaw, swing.roll, 0.25f * swing.lean);
    std::array<FootPlace, 2> feet;
    for (std::size_t i = 0; i < 2; ++i) {
        feet[i] = find_foot_place(
            body.legs[i], targets.places[i], targets.headings[i], targets.pitches[i]);
        feet[i].toes = slerp(feet[i].toes, feet[i].rotation, targets.limp[i]);
    }
    Vec3 place = body.hips_place + swing.side * axes.left + targets.shift;
    place.y = smooth_min(
        body.hips_place.y * (1 - style.knee_bend) + swing.up + targets.shift.y,
        highest_hips(body.legs[0], place, hips, feet[0].ankle, targets.slack[0]),
        highest_hips(body.legs[1], place, hips, feet[1].ankle, targets.slack[1]),
        glm::mix(kHipsSoftness, kRunSoftness, swing.run) * length);
    const std::uint16_t head = body.head != kNoPart ? body.head : body.hips;
    const Quat head_before = find_place(skeleton, pose, head).rotation;
    place_hips(skeleton, body, place, hips, pose);
    const Quat level = rotation_about(axes.left, 0.5f * swing.lean + 0.3f * style.tiredness);
    bend_back(skeleton, body, axes, swing, level * head_before, pose);
    const WalkAxes knees = {axes.left, targets.turn * axes.up, targets.turn * axes.forward};
    for (std::size_t i = 0; i < 2; ++i) {
        swing_arm(
            skeleton, body, axes, i, i == 0 ? swing.arm : -swing.arm, style.arm_swing, swing.run,
            style.arms, pose);
        place_leg(skeleton, body.legs[i], feet[i], targets.headings[i], knees, pose);
    }
}

}  // namespace limn
