#include "systems/animation/ik/ik_goal_system.h"

#include "ecs/base/rotation.h"
#include "ecs/components/humanoid.h"
#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/ik/look_at.h"
#include "systems/animation/ik/placements.h"
#include "systems/animation/ik/pose_ik.h"
#include "systems/animation/ik/shoulder_girdle.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>

// Techniques: char.motion-constrain

namespace limn {
namespace {

constexpr std::uint16_t kNoJoint = 0xffff;

/// A point of a goal, or of the character itself, in the character's space.
struct GoalPoint {
    Vec3 position = {NAN, NAN, NAN};
    Quat rotation = {1, 0, 0, 0};
};

GoalPoint
find_point(const Placements& placements, Entity character, Entity goal, const Vec3& position) {
    if (goal.is_null()) {
        return {position, Quat(1, 0, 0, 0)};
    }
    if (!placements.has(goal)) {  // destroyed
        return {};
    }
    Affine character_from_world;
    if (!find_inverse(placements.world(character), character_from_world)) {
        return {};
    }
    const Affine local = character_from_world * placements.world(goal);
    const auto& row = local.row;
    const Mat3 axes(
        Vec3(row[0].x, row[1].x, row[2].x), Vec3(row[0].y, row[1].y, row[2].y),
        Vec3(row[0].z, row[1].z, row[2].z));
    return {transform_point(local, position), extract_rotation(axes).value_or(Quat(1, 0, 0, 0))};
}

/// Index of the joint with this name; `guess` if that is it.
std::uint16_t
find_joint(const SkeletonData& skeleton, const std::string& name, std::uint16_t guess) {
    if (guess < skeleton.joints.size() && skeleton.joints[guess] == name) {
        return guess;
    }
    const auto found = std::find(skeleton.joints.begin(), skeleton.joints.end(), name);
    return found == skeleton.joints.end()
               ? kNoJoint
               : static_cast<std::uint16_t>(found - skeleton.joints.begin());
}

const SkeletonData* skeleton_of(const Assets& assets, const Skeleton& skeleton) {
    return skeleton.skeleton.index < assets.skeletons.size()
               ? &assets.skeletons[skeleton.skeleton.index]
               : nullptr;
}

/// The root of a chain: by name, or so many bones above the tip.
std::uint16_t find_root(
    const SkeletonData& skeleton, const IkChain& chain, std::uint16_t tip, std::uint16_t guess) {
    if (tip == kNoJoint) {
        return kNoJoint;
    }
    if (!chain.root.empty()) {
        const std::uint16_t root = find_joint(skeleton, chain.root, guess);
        for (std::int32_t joint = tip; joint >= 0; joint = skeleton.parents[joint]) {
            if (joint == root) {
                return root;
            }
        }
        return kNoJoint;
    }
    std::uint16_t root = tip;
    for (int i = 0; i < chain.bones && skeleton.parents[root] >= 0; ++i) {
        root = static_cast<std::uint16_t>(skeleton.parents[root]);
    }
    return root;
}

/// Of the limb that ends at `tip`.
std::uint16_t find_limb_collar(const SkeletonData& skeleton, std::uint16_t tip, int bones) {
    return tip == kNoJoint
               ? kNoJoint
               : find_collar(
                   skeleton,
                   find_limb(skeleton, tip, static_cast<std::size_t>(std::max(bones, 2))).root);
}

void update_goals(
    const Placements& placements, Entity entity, const SkeletonData& skeleton, const IkRig& rig,
    IkGoals& goals) {
    const std::size_t count = rig.chains.size();
    goals.positions.resize(count);
    goals.rotations.resize(count);
    goals.tips.resize(count, kNoJoint);
    goals.roots.resize(count, kNoJoint);
    goals.collars.resize(count, kNoJoint);
    for (std::size_t i = 0; i < count; ++i) {
        const IkChain& chain = rig.chains[i];
        const GoalPoint point = find_point(placements, entity, chain.goal, chain.position);
        goals.positions[i] = point.position;
        goals.rotations[i] = point.rotation;
        const std::uint16_t tip = goals.tips[i];
        goals.tips[i] = find_joint(skeleton, chain.tip, tip);
        if (goals.tips[i] != tip) {
            goals.collars[i] = find_limb_collar(skeleton, goals.tips[i], chain.bones);
        }
        goals.roots[i] = find_root(skeleton, chain, goals.tips[i], goals.roots[i]);
    }
}

void find_lookers(const SkeletonData& skeleton, const LookAt& look, Gaze& gaze) {
    if (!look.joints.empty()) {
        gaze.joints.resize(look.joints.size(), kNoJoint);
        for (std::size_t i = 0; i < look.joints.size(); ++i) {
            gaze.joints[i] = find_joint(skeleton, look.joints[i].joint, gaze.joints[i]);
        }
    } else if (gaze.joints.empty()) {
        const BodyJoints body = find_body_joints(skeleton);
        for (const BodyPart part : {BodyPart::Neck, BodyPart::Head}) {
            if (body.has(part)) {
                gaze.joints.push_back(body[part]);
            }
        }
    }
}

void update_gaze(
    const SkeletonData& skeleton, const LookAt& look, const Vec3& target, const Pose* pose,
    float step, Gaze& gaze) {
    find_lookers(skeleton, look, gaze);
    if (gaze.joints.empty() || gaze.joints.back() >= skeleton.joints.size() || !is_finite(target)) {
        gaze.distance = 0;
        return;
    }
    const std::uint16_t eyes = gaze.joints.back();
    const Vec3 from = pose != nullptr && eyes < pose->joints.size()
                          ? transform_point(pose->joints[eyes], Vec3(0))
                          : find_place(skeleton, skeleton.rest, eyes).position;
    const Vec3 way = target - from;
    const float distance = glm::length(way);
    if (!(distance > 1e-6f)) {
        return;
    }
    const LookAngles wanted = look_angles(way);
    const bool is_first = !(gaze.distance > 0) || !(look.speed > 0);
    const float share = is_first ? 1.0f : 1 - std::exp(-look.speed * step);
    const float turn = std::remainder(wanted.yaw - gaze.yaw, 2 * kPi);
    gaze.yaw = std::remainder(gaze.yaw + share * turn, 2 * kPi);
    gaze.pitch += share * (wanted.pitch - gaze.pitch);
    gaze.distance = distance;
}

void update_reach(
    const SkeletonData& skeleton, const ReachGoal& goal, const Vec3& target, double time,
    float step, ReachState& state) {
    state.tips.resize(goal.tips.size(), kNoJoint);
    state.collars.resize(goal.tips.size(), kNoJoint);
    for (std::size_t i = 0; i < goal.tips.size(); ++i) {
        const std::uint16_t tip = state.tips[i];
        state.tips[i] = find_joint(skeleton, goal.tips[i], tip);
        if (state.tips[i] != tip) {
            state.collars[i] = find_limb_collar(skeleton, state.tips[i], goal.bones);
        }
    }
    const bool was_reaching = state.weight > 0;
    state.weight = reach_weight(goal, time);
    if (!is_finite(target)) {
        state.weight = 0;
        return;
    }
    const bool follows = was_reaching && goal.delay > 0;
    state.target += (follows ? 1 - std::exp(-step / goal.delay) : 1.0f) * (target - state.target);
}

}  // namespace

void add_ik_states(
    Query<const IkRig, With<Skeleton>, Without<IkGoals>> rigs,
    Query<const LookAt, With<Skeleton>, Without<Gaze>> looks,
    Query<const ReachGoal, With<Skeleton>, Without<ReachState>> reaches, Commands commands) {
    rigs.each([&](Entity entity, const IkRig&) { commands.add(entity, IkGoals{}); });
    looks.each([&](Entity entity, const LookAt&) { commands.add(entity, Gaze{}); });
    reaches.each([&](Entity entity, const ReachGoal&) { commands.add(entity, ReachState{}); });
}

void update_ik_goals(
    Query<const Skeleton, const IkRig, IkGoals> rigs,
    Query<const Skeleton, const LookAt, Optional<const Pose>, Gaze> looks,
    Query<const Skeleton, const ReachGoal, ReachState> reaches, Query<const Transform> transforms,
    Query<const Parent> parents, Res<const Assets> assets, OptionalRes<const FrameTime> time) {
    const Placements placements(transforms, parents);
    const float step = time ? time->step : 0.0f;
    const double now = time ? time->time : 0.0;
    rigs.each([&](Entity entity, const Skeleton& skeleton, const IkRig& rig, IkGoals& goals) {
        if (const SkeletonData* const data = skeleton_of(*assets, skeleton)) {
            update_goals(placements, entity, *data, rig, goals);
        }
    });
    looks.each([&](Entity entity, const Skeleton& skeleton, const LookAt& look, const Pose* pose,
                   Gaze& gaze) {
        if (const SkeletonData* const data = skeleton_of(*assets, skeleton)) {
            const GoalPoint point = find_point(placements, entity, look.target, look.position);
            update_gaze(*data, look, point.position, pose, step, gaze);
        }
    });
    reaches.each(
        [&](Entity entity, const Skeleton& skeleton, const ReachGoal& goal, ReachState& state) {
            if (const SkeletonData* const data = skeleton_of(*assets, skeleton)) {
                const GoalPoint point = find_point(placements, entity, goal.target, goal.position);
                update_reach(*data, goal, point.position, now, step, state);
            }
        });
}

}  // namespace limn
