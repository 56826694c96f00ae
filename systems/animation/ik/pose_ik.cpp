#include "systems/animation/ik/pose_ik.h"

#include "ecs/base/rotation.h"
#include "systems/animation/ik/ccd.h"
#include "systems/animation/ik/fabrik.h"
#include "systems/animation/ik/hybrid_ik.h"
#include "systems/animation/ik/look_at.h"
#include "systems/animation/ik/penalty_ik.h"
#include "systems/animation/ik/shoulder_girdle.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

// Techniques: char.elbow-circle, char.ik-hybrid, char.ik-iterate, char.ik-penalty,
//     char.ik-two-link, char.ik-weights, char.motion-constrain

namespace limn {
namespace {

constexpr std::uint16_t kMissingJoint = 0xffff;
// Of joints without freedoms in hybrid chains, and of the root; by eye.
constexpr float kSpineStiffness = 0.25f;
constexpr float kRootStiffness = 1.0f;
constexpr float kHybridStiffness = 2e-3f;  // factor on both [m^2/rad^2]

/// A part of a skeleton as a tree; buffers are reused.
struct BodyTree {
    std::vector<std::uint16_t> joints;
    JointTree tree;
    JointState state;

    void read(const SkeletonData& skeleton, const LocalPose& pose) {
        make_joint_tree(skeleton, joints, tree);
        read_pose(skeleton, pose, joints, tree, state);
    }

    /// Index in the tree of a joint of the skeleton that it has.
    [[nodiscard]] std::uint16_t find(std::uint16_t joint) const {
        const auto found = std::lower_bound(joints.begin(), joints.end(), joint);
        return static_cast<std::uint16_t>(found - joints.begin());
    }

    void write(float weight, LocalPose& pose) const {
        for (std::size_t i = 0; i < joints.size(); ++i) {
            Quat& local = pose.rotations[joints[i]];
            const Quat solved = local_rotation(tree, state, static_cast<std::uint16_t>(i));
            local = weight < 1 ? slerp(local, solved, weight) : solved;
        }
    }
};

std::uint16_t collar_of(std::span<const std::uint16_t> collars, std::size_t limb) {
    return limb < collars.size() ? collars[limb] : kMissingJoint;
}

bool is_solved_jointly(const IkChain& chain) {
    return chain.solver == IkSolver::Penalty || chain.solver == IkSolver::Hybrid;
}

/// Whether chain `i` of the rig has joints to move and a goal.
bool can_reach(const IkRig& rig, const IkGoals& goals, std::size_t i) {
    return i < goals.tips.size() && goals.tips[i] != kMissingJoint
           && goals.roots[i] != kMissingJoint && is_finite(goals.positions[i])
           && rig.chains[i].weight > 0;
}

void list_path(
    const SkeletonData& skeleton, std::uint16_t root, std::uint16_t tip,
    std::vector<std::uint16_t>& joints) {
    joints.clear();
    for (std::int32_t joint = tip; joint >= 0; joint = skeleton.parents[joint]) {
        joints.push_back(static_cast<std::uint16_t>(joint));
        if (joint == root) {
            break;
        }
    }
    std::reverse(joints.begin(), joints.end());
}

void set_weights(const IkChain& chain, JointTree& tree) {
    for (JointAxis& axis : tree.axes) {
        const float own = axis.joint < chain.tones.size() ? chain.tones[axis.joint] : 1.0f;
        axis.weight = std::clamp(chain.tone * own, 0.0f, 1.0f);
    }
}

Quat rotation_in(const Affine& matrix) {
    const auto& row = matrix.row;
    const Mat3 axes(
        Vec3(row[0].x, row[1].x, row[2].x), Vec3(row[0].y, row[1].y, row[2].y),
        Vec3(row[0].z, row[1].z, row[2].z));
    return extract_rotation(axes).value_or(Quat(1, 0, 0, 0));
}

/// Takes the rotations of the last step.
void continue_from(const SkeletonData& skeleton, std::span<const Affine> last, BodyTree& part) {
    for (std::size_t i = 0; i < part.joints.size(); ++i) {
        const std::uint16_t joint = part.joints[i];
        const std::int32_t parent = skeleton.parents[joint];
        const Quat before = parent < 0 ? Quat(1, 0, 0, 0) : rotation_in(last[parent]);
        set_local_rotation(
            part.tree, glm::conjugate(before) * rotation_in(last[joint]),
            static_cast<std::uint16_t>(i), part.state);
    }
}

void solve_chain(
    const SkeletonData& skeleton, const IkChain& chain, const IkGoals& goals, std::size_t index,
    std::span<const Affine> last, LocalPose& pose) {
    thread_local BodyTree part;
    list_path(skeleton, goals.roots[index], goals.tips[index], part.joints);
    part.read(skeleton, pose);
    if (chain.continues && last.size() == pose.size()) {
        continue_from(skeleton, last, part);
    }
    set_weights(chain, part.tree);
    const Effector tip = {part.find(goals.tips[index]), chain.offset};
    const Vec3& goal = goals.positions[index];
    if (chain.solver == IkSolver::Ccd) {
        const CcdOptions options = {.passes = chain.iterations, .limits = chain.limits};
        solve_ccd(part.tree, tip, goal, options, part.state);
    } else if (chain.solver == IkSolver::Fabrik) {
        const FabrikOptions options = {.iterations = chain.iterations, .limits = chain.limits};
        solve_fabrik(part.tree, tip, goal, options, part.state);
    } else {
        const IkOptions options = {
            .iterations = chain.iterations, .comfort = chain.comfort, .limits = chain.limits};
        IkGoal wanted = {goal, {}};
        if (chain.orient) {
            wanted.rotation = goals.rotations[index];
        }
        iterate_ik(part.tree, tip, wanted, options, part.state);
    }
    part.write(std::min(chain.weight, 1.0f), pose);
}

LimbOptions limb_options(const IkChain& chain) {
    return {.pole = chain.pole, .swivel = chain.swivel, .softness = chain.softness};
}

/// All joints from the root of the skeleton to the tips of the chains with this solver.
void list_bodies(
    const SkeletonData& skeleton, const IkRig& rig, const IkGoals& goals, IkSolver solver,
    std::vector<std::uint16_t>& joints) {
    joints.clear();
    for (std::size_t i = 0; i < rig.chains.size(); ++i) {
        if (rig.chains[i].solver == solver && can_reach(rig, goals, i)) {
            for (std::int32_t joint = goals.tips[i]; joint >= 0; joint = skeleton.parents[joint]) {
                joints.push_back(static_cast<std::uint16_t>(joint));
            }
        }
    }
    std::sort(joints.begin(), joints.end());
    joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
}

void solve_penalty_chains(
    const SkeletonData& skeleton, const IkRig& rig, const IkGoals& goals, LocalPose& pose) {
    thread_local BodyTree body;
    thread_local std::vector<PenaltyGoal> wanted;
    thread_local std::vector<std::uint16_t> path;
    list_bodies(skeleton, rig, goals, IkSolver::Penalty, body.joints);
    if (body.joints.empty()) {
        return;
    }
    body.read(skeleton, pose);
    for (JointAxis& axis : body.tree.axes) {
        axis.weight = 0;  // unless a chain has it
    }
    wanted.clear();
    PenaltyOptions options = {.iterations = 0, .stiffness = 0, .limits = false};
    for (std::size_t i = 0; i < rig.chains.size(); ++i) {
        const IkChain& chain = rig.chains[i];
        if (chain.solver != IkSolver::Penalty || !can_reach(rig, goals, i)) {
            continue;
        }
        wanted.push_back(
            {{body.find(goals.tips[i]), chain.offset}, goals.positions[i], chain.weight});
        options.iterations = std::max(options.iterations, chain.iterations);
        options.stiffness = std::max(options.stiffness, chain.comfort);
        options.limits |= chain.limits;
        list_path(skeleton, goals.roots[i], goals.tips[i], path);
        for (JointAxis& axis : body.tree.axes) {
            if (std::binary_search(path.begin(), path.end(), body.joints[axis.joint])) {
                axis.weight = 1;
            }
        }
    }
    minimize_penalty(body.tree, wanted, options, body.state);
    body.write(1, pose);
}

void solve_hybrid_chains(
    const SkeletonData& skeleton, const IkRig& rig, const IkGoals& goals, LocalPose& pose) {
    thread_local BodyTree body;
    thread_local std::vector<BodyLimb> limbs;
    list_bodies(skeleton, rig, goals, IkSolver::Hybrid, body.joints);
    if (body.joints.empty()) {
        return;
    }
    body.read(skeleton, pose);
    JointTree& tree = body.tree;
    for (JointAxis& axis : tree.axes) {
        const float free = axis.joint == 0 ? kRootStiffness : kSpineStiffness;
        axis.stiffness = axis.kind == AxisKind::Free ? free : axis.stiffness;
    }
    for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(1, 0, 0)}) {
        tree.axes.insert(
            tree.axes.begin(),
            {.joint = 0, .kind = AxisKind::Slide, .axis = axis, .min = -rig.hips, .max = rig.hips});
    }
    body.state.values.insert(body.state.values.begin(), 3, 0.0f);
    limbs.clear();
    HybridOptions options = {
        .spine = {.iterations = 0, .stiffness = kHybridStiffness}, .limits = false};
    for (std::size_t i = 0; i < rig.chains.size(); ++i) {
        const IkChain& chain = rig.chains[i];
        if (chain.solver != IkSolver::Hybrid || !can_reach(rig, goals, i)) {
            continue;
        }
        const auto bones = static_cast<std::size_t>(std::max(chain.bones, 2));
        const LimbJoints limb = find_limb(skeleton, goals.tips[i], bones);
        limbs.push_back(
            {body.find(limb.root), body.find(limb.middle), body.find(limb.tip), goals.positions[i],
             limb_options(chain)});
        options.spine.iterations = std::max(options.spine.iterations, chain.iterations);
        options.limits |= chain.limits;
    }
    solve_hybrid(tree, limbs, options, body.state);
    const std::vector<float>& moved = body.state.values;
    pose.translations[body.joints[0]] +=
        tree.base_rotation * tree.rests[0] * Vec3(moved[0], moved[1], moved[2]);
    body.write(1, pose);
    for (std::size_t i = 0; i < rig.chains.size(); ++i) {
        const IkChain& chain = rig.chains[i];
        if (chain.solver == IkSolver::Hybrid && chain.orient && can_reach(rig, goals, i)) {
            set_joint_rotation(skeleton, goals.tips[i], goals.rotations[i], 1, pose);
        }
    }
}

}  // namespace

LimbJoints find_limb(const SkeletonData& skeleton, std::uint16_t tip, std::size_t bones) {
    LimbJoints limb = {tip, tip, tip};
    for (std::size_t i = 0; i < bones && skeleton.parents[limb.root] >= 0; ++i) {
        limb.root = static_cast<std::uint16_t>(skeleton.parents[limb.root]);
        limb.middle = i + 1 == (bones + 1) / 2 ? limb.root : limb.middle;
    }
    return limb;
}

void set_joint_rotation(
    const SkeletonData& skeleton, std::uint16_t joint, const Quat& rotation, float weight,
    LocalPose& pose) {
    const Quat before = find_place(skeleton, pose, skeleton.parents[joint]).rotation;
    const Quat local = normalize_or_identity(glm::conjugate(before) * rotation);
    Quat& now = pose.rotations[joint];
    now = weight < 1 ? slerp(now, local, weight) : local;
}

Vec3 reach_with_limb(
    const SkeletonData& skeleton, const LimbJoints& limb, const LimbReach& reach, LocalPose& pose) {
    const JointPlace root = find_place(skeleton, pose, limb.root);
    const JointPlace middle = find_place(skeleton, pose, limb.middle);
    const JointPlace tip = find_place(skeleton, pose, limb.tip);
    const LimbPoints now = {
        root.position, middle.position, tip.position + tip.rotation * (tip.scale * reach.offset)};
    LimbOptions options = reach.options;
    const auto hinge = std::find_if(
        skeleton.freedoms.begin(), skeleton.freedoms.end(),
        [&](const JointFreedom& freedom) { return freedom.joint == limb.middle; });
    const Quat before_middle = middle.rotation * glm::conjugate(pose.rotations[limb.middle]);
    if (hinge != skeleton.freedoms.end() && options.hinge == Vec3(0)) {
        options.hinge = before_middle * skeleton.rest.rotations[limb.middle] * hinge->axis;
    }
    const LimbPoints solved = solve_limb(now, reach.target, options);
    const LimbTurn turn = find_limb_turn(now, solved, options.hinge);
    const float weight = std::clamp(reach.weight, 0.0f, 1.0f);
    const auto blend = [&](std::uint16_t joint, const Quat& before, const Quat& after) {
        Quat& local = pose.rotations[joint];
        const Quat wanted = normalize_or_identity(glm::conjugate(before) * after);
        local = weight < 1 ? slerp(local, wanted, weight) : wanted;
    };
    blend(limb.middle, turn.upper * before_middle, turn.lower * middle.rotation);
    blend(
        limb.root, root.rotation * glm::conjugate(pose.rotations[limb.root]),
        turn.upper * root.rotation);
    return solved.tip;
}

void apply_ik_rig(
    const SkeletonData& skeleton, const IkRig& rig, const IkGoals& goals,
    std::span<const Affine> last, LocalPose& pose) {
    solve_penalty_chains(skeleton, rig, goals, pose);
    solve_hybrid_chains(skeleton, rig, goals, pose);
    for (std::size_t i = 0; i < rig.chains.size(); ++i) {
        const IkChain& chain = rig.chains[i];
        if (is_solved_jointly(chain) || !can_reach(rig, goals, i)) {
            continue;
        }
        if (chain.solver != IkSolver::TwoLink) {
            solve_chain(skeleton, chain, goals, i, last, pose);
            continue;
        }
        const auto bones = static_cast<std::size_t>(std::max(chain.bones, 2));
        LimbReach reach = {goals.positions[i], chain.offset, limb_options(chain), chain.weight};
        if (chain.orient) {  // then the offset has the direction that the goal gives it
            reach.target -= goals.rotations[i] * chain.offset;
            reach.offset = Vec3(0);
        }
        const LimbJoints limb = find_limb(skeleton, goals.tips[i], bones);
        reach_with_arm(skeleton, collar_of(goals.collars, i), limb, reach, pose);
        if (chain.orient) {
            set_joint_rotation(skeleton, limb.tip, goals.rotations[i], chain.weight, pose);
        }
    }
}

void apply_look_at(
    const SkeletonData& skeleton, const LookAt& look, const Gaze& gaze, LocalPose& pose) {
    thread_local std::vector<LookJoint> joints;
    joints.clear();
    for (std::size_t i = 0; i < gaze.joints.size(); ++i) {
        const std::uint16_t joint = gaze.joints[i];
        if (joint >= pose.size()) {
            continue;
        }
        LookJoint& looks = joints.emplace_back();
        looks.joint = joint;
        // Where it looks in the rest pose, seen from the joint.
        const Quat rest = find_place(skeleton, skeleton.rest, joint).rotation;
        looks.forward = glm::conjugate(rest) * normalize_or(look.facing, Vec3(0, 0, 1));
        if (i < look.joints.size()) {
            looks.share = look.joints[i].share;
            looks.max_yaw = look.joints[i].max_yaw;
            looks.max_pitch = look.joints[i].max_pitch;
        } else if (i + 1 < gaze.joints.size()) {
            looks.share = 0.4f;  // the neck of a person
        }
    }
    if (joints.empty() || !(gaze.distance > 0)) {
        return;
    }
    const Vec3 eyes = find_place(skeleton, pose, joints.back().joint).position;
    look_at(
        skeleton, joints, eyes + gaze.distance * look_direction({gaze.yaw, gaze.pitch}),
        look.weight, pose);
}

float reach_weight(const ReachGoal& goal, double time) {
    double since = time - double(goal.time);
    if (goal.period > 0) {
        const double period = double(goal.period);
        since -= period * std::floor((since + double(goal.before)) / period);
    }
    const auto ease = [](double u) {
        const double x = std::clamp(u, 0.0, 1.0);
        return static_cast<float>(x * x * (3 - 2 * x));
    };
    if (since < 0) {
        return goal.before > 0 ? ease(1 + since / double(goal.before)) : 0.0f;
    }
    const double past = since - double(goal.hold);
    if (past <= 0) {
        return 1;
    }
    return goal.after > 0 ? ease(1 - past / double(goal.after)) : 0.0f;
}

void apply_reach(
    const SkeletonData& skeleton, const ReachGoal& goal, const ReachState& state, LocalPose& pose) {
    if (!(state.weight > 0) || !is_finite(state.target) || pose.size() == 0) {
        return;
    }
    const auto bones = static_cast<std::size_t>(std::max(goal.bones, 2));
    LimbReach reach = {state.target, goal.offset, {}, state.weight};
    if (goal.policy == ReachPolicy::Must) {
        // What the limb that gets nearest lacks, at full weight.
        thread_local LocalPose trial;
        Vec3 lacks(INFINITY);
        for (std::size_t i = 0; i < state.tips.size(); ++i) {
            const std::uint16_t tip = state.tips[i];
            if (tip < pose.size()) {
                trial = pose;
                const LimbJoints limb = find_limb(skeleton, tip, bones);
                LimbReach whole = reach;
                whole.weight = 1;
                const Vec3 end =
                    reach_with_arm(skeleton, collar_of(state.collars, i), limb, whole, trial);
                const Vec3 left = state.target - end;
                lacks = glm::dot(left, left) < glm::dot(lacks, lacks) ? left : lacks;
            }
        }
        if (is_finite(lacks)) {
            pose.translations[0] += state.weight * lacks;
        }
    }
    for (std::size_t i = 0; i < state.tips.size(); ++i) {
        const std::uint16_t tip = state.tips[i];
        if (tip < pose.size()) {
            const LimbJoints limb = find_limb(skeleton, tip, bones);
            reach_with_arm(skeleton, collar_of(state.collars, i), limb, reach, pose);
        }
    }
}

}  // namespace limn
