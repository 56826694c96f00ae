#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <string>
#include <vector>

namespace limn {

// Inverse kinematics of characters: with a Skeleton, changes its pose after the clip, before the
// joint matrices, so that hands, feet, tools and heads are where they have to be. Angles and axes
// of joints are in SkeletonData::freedoms.
// Techniques: char.ik-two-link, char.ik-iterate, char.ik-weights, char.motion-constrain

enum class IkSolver : std::uint8_t {
    TwoLink,   ///< closed form: three joints, the middle one bends
    Jacobian,  ///< damped pseudo-inverse of the Jacobian, in small steps
    Ccd,       ///< cyclic coordinate descent
    Fabrik,    ///< forward and backward reaching
    Penalty,   ///< all chains of the character that have it share the error by their weights
    Hybrid,    ///< hips and spine of the character move until its limbs can reach; limbs in closed
               ///< form
};

/// A chain of joints whose tip reaches for a goal.
struct IkChain {
    std::string tip{};
    std::string root{};
    int bones = 2;
    IkSolver solver = IkSolver::TwoLink;
    Vec3 offset = {0, 0, 0};
    Entity goal{};
    Vec3 position = {0, 0, 0};
    bool orient = false;
    float weight = 1.0f;
    int iterations = 16;
    float tone = 1.0f;
    std::vector<float> tones{};
    Vec3 pole = {0, 0, 0};
    float swivel = 0.0f;
    float softness = 0.0f;
    float comfort = 0.0f;
    bool limits = true;
    bool continues = false;
};

LIMN_FIELDS(IkChain) {
    LIMN_FIELD(tip, "name of the joint that reaches");
    LIMN_FIELD(root, "name of the first joint of the chain; empty: `bones` above the tip");
    LIMN_FIELD(bones, "number of bones from the root to the tip", "", 1, 64);
    LIMN_FIELD(
        solver, .doc = "method; two_link and hybrid bend the joint halfway",
        .values = "two_link jacobian ccd fabrik penalty hybrid");
    LIMN_FIELD(offset, "point that reaches, in the tip's space", "m");
    LIMN_FIELD(goal, "entity to reach, by name; none: a point of the character's space");
    LIMN_FIELD(position, "point to reach, in the goal's space", "m");
    LIMN_FIELD(orient, "the tip also takes the rotation of the goal; two_link, jacobian, hybrid");
    LIMN_FIELD(
        weight, "from the animated pose, 0, to the goal, 1; penalty: of this goal", "", 0, 100);
    LIMN_FIELD(iterations, "per step; penalty and hybrid: the largest of all chains", "", 0, 256);
    LIMN_FIELD(
        tone, "muscle tone: share of each iteration that the joints take; jacobian, ccd, fabrik",
        "", 0, 1);
    LIMN_FIELD(tones, "of the single joints, from the root, times tone", "", 0, 1);
    LIMN_FIELD(
        pole, "direction in the character's space that elbow or knee point to; 0: as animated");
    LIMN_FIELD(swivel, "of elbow or knee about the line from root to tip", "rad", -6.3, 6.3);
    LIMN_FIELD(softness, "last part of the reach over which elbow or knee straighten", "m", 0, 10);
    LIMN_FIELD(
        comfort,
        "pull of stiff joints to the middle of their range, without moving the tip; "
        "jacobian, penalty",
        "", 0, 0.5);
    LIMN_FIELD(limits, "joints keep their limits");
    LIMN_FIELD(
        continues, "starts from the last step's pose, not the animated one; jacobian, ccd, fabrik");
}

/// With a Skeleton: chains in this order, each on the result of the ones before it.
struct IkRig {
    std::vector<IkChain> chains{};
    float hips = 0.25f;
};

LIMN_FIELDS(IkRig) {
    LIMN_FIELD(chains, "chains of joints, solved in this order");
    LIMN_FIELD(hips, "farthest that the root may be moved by hybrid chains", "m", 0, 10);
}

/// What the solver needs to know of an IkRig, found before each step.
struct IkGoals {
    std::vector<Vec3> positions;              ///< of each chain's goal in the character's space [m]
    std::vector<Quat> rotations;              ///< likewise
    std::vector<std::uint16_t> tips;          ///< joints; 0xffff: there is none of that name
    std::vector<std::uint16_t> roots;         ///< likewise
    std::vector<std::uint16_t> collars = {};  ///< that carry the chains' limbs; 0xffff: none
};
template <>
struct ComponentTraits<IkGoals> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

/// A joint that turns to look.
struct LookAtJoint {
    std::string joint{};
    float share = 1.0f;
    float max_yaw = 1.0f;
    float max_pitch = 0.6f;
};

LIMN_FIELDS(LookAtJoint) {
    LIMN_FIELD(joint, "by name");
    LIMN_FIELD(share, "of the turn that the joints before it have left", "", 0, 1);
    LIMN_FIELD(max_yaw, "to each side of the animated pose", "rad", 0, 3.2);
    LIMN_FIELD(max_pitch, "up and down from the animated pose", "rad", 0, 1.6);
}

/// With a Skeleton: its head turns to a target.
struct LookAt {
    Entity target{};
    Vec3 position = {0, 0, 0};
    std::vector<LookAtJoint> joints{};
    Vec3 facing = {0, 0, 1};
    float weight = 1.0f;
    float speed = 8.0f;
};

LIMN_FIELDS(LookAt) {
    LIMN_FIELD(target, "entity to look at, by name; none: a point of the character's space");
    LIMN_FIELD(position, "point to look at, in the target's space", "m");
    LIMN_FIELD(joints, "from the neck to the eyes; empty: neck and head of a person");
    LIMN_FIELD(facing, "where they look in the rest pose, in the character's space");
    LIMN_FIELD(weight, "from the animated pose, 0, to the target, 1", "", 0, 1);
    LIMN_FIELD(speed, "rate at which the gaze follows; 0: at once", "1/s", 0, 1000);
}

/// Where a LookAt looks; it follows its target with a delay.
struct Gaze {
    float yaw = 0.0f;
    float pitch = 0.0f;
    float distance = 0.0f;
    std::vector<std::uint16_t> joints{};
};

LIMN_FIELDS(Gaze) {
    LIMN_FIELD(yaw, "about +y from +z toward +x, in the character's space", "rad");
    LIMN_FIELD(pitch, "up", "rad");
    LIMN_FIELD(distance, "of the target; 0: none yet", "m");
    LIMN_FIELD(joints, "indices of the joints that look");
}

enum class ReachPolicy : std::uint8_t {
    Strive,  ///< as far as the limb reaches
    Must,    ///< moves the whole body by what is left
};

/// With a Skeleton: an animation that has to meet a target at a time, such as the hands of a
/// goalkeeper and the ball. Before and after, it goes over into the animation and back.
struct ReachGoal {
    std::vector<std::string> tips{};
    int bones = 2;
    Vec3 offset = {0, 0, 0};
    Entity target{};
    Vec3 position = {0, 0, 0};
    float time = 1.0f;
    float period = 0.0f;
    float before = 0.3f;
    float after = 0.3f;
    float hold = 0.0f;
    float delay = 0.05f;
    ReachPolicy policy = ReachPolicy::Strive;
};

LIMN_FIELDS(ReachGoal) {
    LIMN_FIELD(tips, "names of the joints that reach: one hand, or both");
    LIMN_FIELD(bones, "number of bones of each limb; the joint halfway bends", "", 2, 64);
    LIMN_FIELD(offset, "point that reaches, in the tips' space", "m");
    LIMN_FIELD(target, "entity to reach, by name; none: a point of the character's space");
    LIMN_FIELD(position, "point to reach, in the target's space", "m");
    LIMN_FIELD(time, "at which the target is reached", "s");
    LIMN_FIELD(period, "after which the same happens again; 0: once", "s", 0);
    LIMN_FIELD(before, "over which the pose eases in", "s", 0, 60);
    LIMN_FIELD(after, "over which it eases out", "s", 0, 60);
    LIMN_FIELD(hold, "for which the target is held, from `time`", "s", 0, 3600);
    LIMN_FIELD(delay, "time constant with which it follows a target that moves", "s", 0, 10);
    LIMN_FIELD(policy, .doc = "what happens beyond the limb's reach", .values = "strive must");
}

/// State of a ReachGoal.
struct ReachState {
    Vec3 target = {0, 0, 0};
    float weight = 0.0f;
    std::vector<std::uint16_t> tips{};
    std::vector<std::uint16_t> collars{};
};

LIMN_FIELDS(ReachState) {
    LIMN_FIELD(target, "where the target seems to be, in the character's space", "m");
    LIMN_FIELD(weight, "of the reach, 0: the animation", "", 0, 1);
    LIMN_FIELD(tips, "indices of the joints");
    LIMN_FIELD(collars, "of the collar bones of those that are hands; 65535: none");
}

}  // namespace limn
