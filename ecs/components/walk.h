#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <array>
#include <cstdint>
#include <vector>

namespace limn {

// A walk that is made, not recorded: feet fly from print to print, legs follow by inverse
// kinematics, hips, spine and arms by periodic functions. Planted feet cannot slide, since their
// prints are given.
// After A. Watt, F. Policarpo, "Advanced Game Development with Programmable Graphics Hardware"
// (2005), chapter 9, tables 9.1 and 9.2.
// Techniques: char.walk-control

/// How much of its work each part of a leg does, 1: all of it. Less makes a limp.
struct LegWeights {
    float hip = 1.0f;
    float knee = 1.0f;
    float ankle = 1.0f;
};

LIMN_FIELDS(LegWeights) {
    LIMN_FIELD(hip, "less: shorter steps, and less time on this leg", "", 0, 1);
    LIMN_FIELD(knee, "less: a stiff leg that swings around", "", 0, 1);
    LIMN_FIELD(ankle, "less: a flat foot that does not roll", "", 0, 1);
}

/// With a Skeleton of a person, or of anything with joints of those names: walks where its
/// MoveIntent says, in the style of these parameters. Moves its Transform, unless something else
/// does, and walks along. Lengths are in the space of the Transform's parent.
struct Walk {
    // Flight path of the feet.
    float speed = 1.3f;
    float stride = 0.0f;
    float step_height = 0.05f;
    float plateau = 0.3f;
    std::vector<Vec2> flight = {};
    // Limits of joints, and where they like to be.
    float knee_bend = 0.004f;
    float stoop = 0.0f;
    float width = 0.7f;
    float toe_off = 0.95f;
    float heel_strike = 0.3f;
    // Weights.
    LegWeights left = {};
    LegWeights right = {};
    float tiredness = 0.0f;
    // Rotation of the hips.
    float hip_yaw = 0.1f;
    float hip_roll = 0.05f;
    float sway = 0.02f;
    float bob = 0.005f;
    // Swing of the arms.
    float arm_swing = 0.4f;
    float arms = 1.0f;
    // How it gets going.
    float response = 0.2f;
    float turn_speed = 1.8f;
    bool moves_root = true;
};

LIMN_FIELDS(Walk) {
    LIMN_FIELD(speed, "comfortable speed, at which a cycle is one stride", "m/s", 0.05, 100);
    LIMN_FIELD(
        stride, "of a cycle, two steps, at that speed; longer when faster; 0: 1.6 legs", "m", 0,
        100);
    LIMN_FIELD(step_height, "highest that a flying foot rises above the ground", "m", 0, 10);
    LIMN_FIELD(plateau, "how level a foot is held before it lands", "", 0, 1);
    LIMN_FIELD(
        flight, "a curve in place of the usual one, at equal times from lift-off to landing: "
                "forward, 0 to 1 of the step, and height, 1 of step_height");
    LIMN_FIELD(knee_bend, "share of their height by which hips are lowered", "", 0, 0.5);
    LIMN_FIELD(stoop, "the back bends forward by this", "rad", -0.5, 1.2);
    LIMN_FIELD(width, "distance between the feet, relative to the hip joints", "", 0.2, 3);
    LIMN_FIELD(toe_off, "pitch of a foot on its toes when it leaves the ground", "rad", 0, 1.3);
    LIMN_FIELD(heel_strike, "pitch of a foot on its heel when it lands", "rad", 0, 0.8);
    LIMN_FIELD(left, "weights of the joints of the left leg");
    LIMN_FIELD(right, "weights of the joints of the right leg");
    LIMN_FIELD(tiredness, "slower, shorter and lower steps, hanging head and arms", "", 0, 1);
    LIMN_FIELD(hip_yaw, "amplitude of the pelvis about the vertical", "rad", 0, 0.6);
    LIMN_FIELD(hip_roll, "by which the pelvis drops on the side of the flying foot", "rad", 0, 0.4);
    LIMN_FIELD(sway, "amplitude of the hips toward the foot on the ground", "leg lengths", 0, 0.3);
    LIMN_FIELD(bob, "amplitude of the hips up and down", "leg lengths", 0, 0.2);
    LIMN_FIELD(arm_swing, "amplitude of the upper arms", "rad", 0, 1.5);
    LIMN_FIELD(arms, "from the arms of the clip, 0, to arms that swing, 1", "", 0, 1);
    LIMN_FIELD(response, "time constant with which the speed changes", "s", 0.02, 5);
    LIMN_FIELD(turn_speed, "fastest turn", "rad/s", 0.05, 20);
    LIMN_FIELD(
        moves_root, "moves the Transform; false: walks where something else moves it, and runs "
                    "where that is faster than people walk");
}

/// What a foot does. Its place is the point of the ground below the ankle of the flat foot; feet on
/// the ground do not move.
struct WalkFoot {
    Vec3 from = {0, 0, 0};
    float from_heading = 0.0f;
    Vec3 to = {0, 0, 0};
    float to_heading = 0.0f;
    Vec3 aim_speed = {0, 0, 0};
    float aim_turn = 0.0f;
    Vec3 place = {0, 0, 0};
    float heading = 0.0f;
    float pitch = 0.0f;
    float lift_pitch = 0.0f;
    float lift_rate = 0.0f;
    float strike = 0.0f;
    float height = 0.0f;
    float flight = 0.75f;
};

LIMN_FIELDS(WalkFoot) {
    LIMN_FIELD(from, "print that it leaves, or stands on", "m");
    LIMN_FIELD(from_heading, "of that print, about +y from +z", "rad");
    LIMN_FIELD(to, "print that it flies to", "m");
    LIMN_FIELD(to_heading, "of that print", "rad");
    LIMN_FIELD(aim_speed, "with which that print moves as plans change", "m/s");
    LIMN_FIELD(aim_turn, "likewise", "rad/s");
    LIMN_FIELD(place, "where it is", "m");
    LIMN_FIELD(heading, "about +y from +z", "rad");
    LIMN_FIELD(pitch, "on its heel, > 0, or on its toes, < 0", "rad");
    LIMN_FIELD(lift_pitch, "pitch when it left the ground", "rad");
    LIMN_FIELD(lift_rate, "its rate then", "rad/s");
    LIMN_FIELD(strike, "pitch with which it lands", "rad");
    LIMN_FIELD(height, "of its flight", "m");
    LIMN_FIELD(
        flight, "steps that its flight lasts: 0.75 in a walk; above 1, both feet fly at times", "",
        0, 2);
}

/// State of a Walk, in the space of the Transform's parent.
struct WalkState {
    static constexpr std::uint32_t kNoFoot = 2;

    std::array<WalkFoot, 2> feet = {};  ///< left, right
    std::uint32_t flying = kNoFoot;     ///< the foot of the current step; kNoFoot: stands
    std::uint32_t placed = 0;           ///< 0: the feet have no prints yet
    float step = 0.0f;                  ///< progress of a step, 0 .. 1
    float phase = 0.0f;
    float phase_rate = 0.0f;
    float activity = 0.0f;
    float activity_aim = 0.0f;
    float vigor = 0.0f;
    float run = 0.0f;
    Vec3 root = {0, 0, 0};
    float heading = 0.0f;
    Vec3 pull = {0, 0, 0};
    float turn = 0.0f;
    Vec3 velocity = {0, 0, 0};
    float lean = 0.0f;
};

LIMN_FIELDS(WalkState) {
    LIMN_FIELD(feet, "left and right");
    LIMN_FIELD(flying, "0: the left foot's step; 1: the right one's; 2: stands", "", 0, 2);
    LIMN_FIELD(placed, "whether the feet have prints", "", 0, 1);
    LIMN_FIELD(step, "progress of the step", "", 0, 1);
    LIMN_FIELD(phase, "of hips and arms: 0 to pi, the left foot's step, then the right's", "rad");
    LIMN_FIELD(phase_rate, "its rate", "rad/s");
    LIMN_FIELD(activity, "0 stands, 1 steps", "", 0, 1);
    LIMN_FIELD(activity_aim, "what it tends to", "", 0, 1);
    LIMN_FIELD(vigor, "speed relative to the comfortable one");
    LIMN_FIELD(run, "0 walks, 1 runs", "", 0, 1);
    LIMN_FIELD(root, "where the character is", "m");
    LIMN_FIELD(heading, "about +y from +z", "rad");
    LIMN_FIELD(pull, "velocity that the velocity tends to", "m/s");
    LIMN_FIELD(turn, "rate of the heading", "rad/s");
    LIMN_FIELD(velocity, "of the root", "m/s");
    LIMN_FIELD(lean, "forward, while it gains speed", "rad");
}

/// Not copied with a prefab: an instance has no history.
template <>
struct ComponentTraits<WalkState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

/// A point of a route.
struct RoutePoint {
    Vec3 position = {0, 0, 0};
    float wait = 0.0f;
    float speed = 0.0f;
};

LIMN_FIELDS(RoutePoint) {
    LIMN_FIELD(position, "in the space of the Transform's parent; y is ignored", "m");
    LIMN_FIELD(wait, "time to stand there", "s", 0, 3600);
    LIMN_FIELD(speed, "on the way there; 0: that of its walk", "m/s", 0, 100);
}

/// With a MoveIntent and a Walk, a MotionMatch or a MotionGraph that moves it: sets the intent so
/// that it goes from point to point.
struct WalkRoute {
    std::vector<RoutePoint> points = {};
    bool loop = true;
    float reach = 0.4f;
};

LIMN_FIELDS(WalkRoute) {
    LIMN_FIELD(points, "in order");
    LIMN_FIELD(loop, "goes on to the first; false: stops at the last");
    LIMN_FIELD(reach, "distance at which it goes on to the next", "m", 0.01, 100);
}

/// State of a WalkRoute.
struct WalkRouteState {
    std::uint32_t next = 0;
    float waited = 0.0f;
};

LIMN_FIELDS(WalkRouteState) {
    LIMN_FIELD(next, "index of the point that it goes to");
    LIMN_FIELD(waited, "at that point", "s");
}

template <>
struct ComponentTraits<WalkRouteState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

/// With a Skeleton, in a crowd: plays one cycle of a walk on the spot, which is made once for all
/// members of a style; something else moves it.
struct CrowdWalk {
    Entity style{};
    float phase = 0.0f;
    float speed = 0.0f;
};

LIMN_FIELDS(CrowdWalk) {
    LIMN_FIELD(style, "entity with the walk that it has, by name");
    LIMN_FIELD(phase, "part of the cycle by which it is ahead of the others", "", 0, 1);
    LIMN_FIELD(speed, "with which it is moved; 0: that of the walk", "m/s", 0, 100);
}

}  // namespace limn
