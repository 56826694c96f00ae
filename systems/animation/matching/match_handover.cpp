#include "systems/animation/matching/match_handover.h"

#include "ecs/base/rotation.h"
#include "systems/animation/graph/inertial_offset.h"
#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/matching/match_feet.h"
#include "systems/animation/walk/walk_plan.h"
#include "systems/animation/walk/walk_pose.h"
#include "systems/animation/walk/walk_step.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

// Techniques: char.blend, char.motion-select

namespace limn {
namespace {

constexpr float kFadeTime = 0.16f;    // of a handover [s]
constexpr float kSamePlace = 0.004f;  // of feet that both poses have on the ground [m]
constexpr float kNeeded = 0.06f;      // weights of a motor's pose above which it is shown,
constexpr float kNoLonger = 0.02f;    // and below which it is not any more
constexpr float kSinkNeeded = 0.05f;  // of the hips [leg lengths]
constexpr float kStoop = 0.8f;        // height of hands, below which a back stoops [hips]

HandoverJoint& show(HandoverJoint& joint, const Quat& rotation, const Vec3& place) {
    joint.last_rotation = joint.rotation;
    joint.last_place = joint.place;
    joint.rotation = rotation;
    joint.place = place;
    return joint;
}

struct ShownJoint {
    Quat rotation = {1, 0, 0, 0};
    Vec3 place = {0, 0, 0};
};

/// Where it would be in a step if it went on as before.
ShownJoint continued(const HandoverJoint& joint) {
    const Quat turn =
        to_same_hemisphere(Quat(1, 0, 0, 0), joint.rotation * glm::conjugate(joint.last_rotation));
    return {
        normalize_or_identity(turn * joint.rotation),
        joint.place + (joint.place - joint.last_place)};
}

/// What a joint shows whose pose wants `target`.
ShownJoint step_joint(
    HandoverStage stage, float clock, float dt, const ShownJoint& target, HandoverJoint& joint) {
    ShownJoint now = target;
    if (stage == HandoverStage::Measure) {
        now = continued(joint);
        joint.target_rotation = target.rotation;
        joint.target_place = target.place;
    } else if (stage == HandoverStage::Fade) {
        if (clock == 0) {
            const ShownJoint next = continued(joint);
            joint.turn = inertial_turn(
                next.rotation, joint.rotation, target.rotation, joint.target_rotation, dt);
            joint.shift =
                inertial_shift(next.place, joint.place, target.place, joint.target_place, dt);
        }
        now.rotation = apply_turn(joint.turn, target.rotation, kFadeTime, clock);
        now.place = apply_shift(joint.shift, target.place, kFadeTime, clock);
    }
    show(joint, now.rotation, now.place);
    return now;
}

/// The first pose, and whatever comes in place of time that has not passed.
void show_as_it_is(
    const SkeletonData& skeleton, const WalkBody& body, const LocalPose& pose,
    MatchHandover& handover) {
    handover.stage = HandoverStage::None;
    handover.joints.assign(pose.size(), {});
    for (std::size_t j = 0; j < pose.size(); ++j) {
        HandoverJoint& joint = handover.joints[j];
        show(show(joint, pose.rotations[j], pose.translations[j]), joint.rotation, joint.place);
    }
    for (std::size_t i = 0; i < 2; ++i) {
        const JointPlace ankle = find_place(skeleton, pose, body.legs[i].foot);
        HandoverJoint& foot = handover.feet[i];
        foot = {};
        show(show(foot, ankle.rotation, ankle.position), ankle.rotation, ankle.position);
    }
}

}  // namespace

bool is_more_than_walking(
    const MotorState& motor, const MotorPoseState& pose, const WalkBody& body, bool away) {
    const float least = away ? kNoLonger : kNeeded;
    const float hands = std::min(pose.hands[0].y, pose.hands[1].y);
    return motor.mode != MotorMode::Stand || motor.gather > 0 || pose.off_ground != 0
           || pose.wade.value > least || pose.push.value > least || pose.swim.value > least
           || (pose.hold.value > least && hands < kStoop * body.hips_place.y)
           || std::abs(pose.sink.value) > kSinkNeeded;
}

void leave_motion_match(
    const MatchContext& context, const Transform& transform, float dt,
    const MotionMatchState& state, WalkState& walk) {
    const WalkBody& body = context.database.body;
    if (state.started == 0 || !body.can_walk || context.motor == nullptr) {
        return;
    }
    const SkeletonData& skeleton = context.skeleton;
    const float scale = uniform_scale(transform);
    const float leg = scale * leg_length(body);
    const Vec3 ahead = transform.rotation * heading_direction(body.heading);
    const Vec3 velocity = {state.velocity.x, 0, state.velocity.y};
    const float speed = glm::length(velocity);
    walk = {};
    walk.placed = 1;
    walk.heading = std::atan2(ahead.x, ahead.z) - dt * state.turn;
    walk.root = transform.position - dt * velocity;
    walk.velocity = walk.pull = velocity;
    walk.turn = state.turn;
    walk.run = run_share(leg, speed);
    const Quat back = glm::conjugate(transform.rotation);
    std::array<float, 2> lifts{};
    for (std::uint32_t i = 0; i < 2; ++i) {
        const WalkLeg& bones = body.legs[i];
        const Quat rest = find_place(skeleton, skeleton.rest, bones.foot).rotation;
        const Quat shown = back * state.feet[i].rotation;
        const Quat turned = shown * glm::conjugate(rest);
        const Vec3 across = turned * bones.across;
        const float heading =
            std::atan2(bones.across.z, bones.across.x) - std::atan2(across.z, across.x);
        const Quat tilt = rotation_about({0, 1, 0}, -heading) * turned;
        const Vec3 axis = {tilt.x, tilt.y, tilt.z};
        WalkFoot& foot = walk.feet[i];
        foot.pitch = -wrap_angle(2 * std::atan2(glm::dot(axis, bones.across), tilt.w));
        const Vec3 ankle = back * (state.feet[i].place - transform.position) / scale
                           - shown * ball_offset(skeleton, bones);
        const Vec3 place = ankle - find_foot_place(bones, Vec3(0), heading, foot.pitch).ankle;
        foot.place = transform.position + transform.rotation * (scale * place);
        lifts[i] = foot.place.y - transform.position.y;
        foot.place.y = transform.position.y;
        foot.from = foot.to = foot.place;
        foot.heading = std::atan2(ahead.x, ahead.z) + wrap_angle(heading);
        foot.from_heading = foot.to_heading = foot.heading;
        foot.lift_pitch = foot.pitch;
        foot.flight = flight_steps(walk.run);
    }
    const std::uint32_t higher = lifts[0] > lifts[1] ? 0 : 1;
    if (state.feet[higher].planted != 1 && speed > 0.3f * leg) {  // it is in the middle of a step
        walk.flying = higher;
        walk.step = std::min(0.5f * walk.feet[higher].flight, 0.9f);
        WalkFoot& foot = walk.feet[higher];
        const float s = flight_progress(walk, higher);
        const float share = flight_point({}, s).x;
        foot.to += 0.4f * leg * velocity / speed;
        foot.from += (foot.place - foot.to) * (share / (1 - share));
        const float most = glm::mix(flight_point({}, s).y, kick_height(s), walk.run);
        foot.height = std::max(lifts[higher], 0.0f) / std::max(most, 0.1f);
        foot.place.y += std::max(lifts[higher], 0.0f);
        walk.activity = walk.activity_aim = 1;
        walk.vigor = speed / 1.3f;
        walk.phase = kPi * (walk.step + static_cast<float>(higher));
    }
}

void step_handover(
    const SkeletonData& skeleton, const WalkBody& body, bool away, float dt,
    MatchHandover& handover, LocalPose& pose) {
    if (!body.can_walk || pose.size() != skeleton.joints.size()) {
        return;
    }
    if (handover.joints.size() != pose.size()) {
        handover.away = away ? 1 : 0;
        show_as_it_is(skeleton, body, pose, handover);
        return;
    }
    if (!(dt > 0)) {
        return;
    }
    if ((handover.away != 0) != away) {
        handover.away = away ? 1 : 0;
        handover.stage = HandoverStage::Measure;
    } else if (handover.stage == HandoverStage::Measure) {
        handover.stage = HandoverStage::Fade;
        handover.clock = 0;
    } else if (handover.stage == HandoverStage::Fade) {
        handover.clock += dt;
        handover.stage = handover.clock < kFadeTime ? HandoverStage::Fade : HandoverStage::None;
    }
    std::array<MatchFoot, 2> feet{};
    for (std::size_t i = 0; i < 2; ++i) {
        const WalkLeg& leg = body.legs[i];
        const JointPlace ankle = find_place(skeleton, pose, leg.foot);
        HandoverJoint& shown = handover.feet[i];
        ShownJoint now =
            step_joint(handover.stage, handover.clock, dt, {ankle.rotation, ankle.position}, shown);
        const bool begins = handover.stage == HandoverStage::Measure;
        if (begins && glm::distance(now.place, ankle.position) < kSamePlace) {
            now.place = shown.place = ankle.position;
        }
        feet[i].place = now.place + now.rotation * ball_offset(skeleton, leg);
        feet[i].rotation = now.rotation;
        feet[i].hold = away ? 0.0f : 1.0f;
    }
    for (std::size_t j = 0; j < pose.size(); ++j) {
        const ShownJoint now = step_joint(
            handover.stage, handover.clock, dt, {pose.rotations[j], pose.translations[j]},
            handover.joints[j]);
        pose.rotations[j] = now.rotation;
        pose.translations[j] = now.place;
    }
    if (handover.stage != HandoverStage::None) {
        apply_match_feet(skeleton, body, feet, Transform{}, pose);
    }
}

}  // namespace limn
