#pragma once

#include "ecs/base/math.h"
#include "ecs/components/motion_graph.h"
#include "ecs/components/skeleton.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <array>
#include <cstdint>
#include <vector>

namespace limn {

// Motion matching: no states and no transitions are written. Several times a second, the frame of
// all clips is found that continues the pose and goes where the character wants to go; it plays
// from there on. After S. Clavet, "Motion Matching and The Road to Next-Gen Animation", GDC 2016,
// and D. Holden et al., "Learned Motion Matching", SIGGRAPH 2020. Techniques: char.blend,
// char.motion-select

/// With a Skeleton of a person, or of anything with joints of those names, and a MoveIntent: clips
/// animate it, and their root motion moves its Transform. Joints that no clip animates keep the
/// pose of its ClipPlayer. With a CharacterMotor, the motor moves it as the clips do, as far as the
/// ground and walls let it; with a Walk and a MotorPose as well, these pose it while it jumps,
/// wades, swims, pushes or stoops, and the poses blend into each other.
struct MotionMatch {
    std::vector<ClipId> clips{};
    Entity walk{};
    float interval = 0.1f;
    float blend = 0.35f;
    float better = 0.1f;
    float trajectory = 1.0f;
    float feet = 0.7f;
    float hips = 0.7f;
    float response = 0.22f;
    float acceleration = 2.2f;
    float turn_speed = 2.2f;
    float steer = 0.8f;
    float pace = 0.2f;
};

LIMN_FIELDS(MotionMatch) {
    LIMN_FIELD(
        clips, "clips of the level, by name, whose hips move over the ground as the person did");
    LIMN_FIELD(
        walk, "entity whose walk performs the takes: starts, stops, turns, runs; none: without "
              "clips, the default walk");
    LIMN_FIELD(interval, "time between two searches", "s", 0, 10);
    LIMN_FIELD(
        blend, "time in which the difference to the previous pose decays; 0: cuts", "s", 0, 5);
    LIMN_FIELD(
        better, "share of its cost by which another frame must be better than the one that plays",
        "", 0, 1);
    LIMN_FIELD(trajectory, "weight of the wanted path and directions", "", 0, 100);
    LIMN_FIELD(feet, "weight of the places and velocities of the feet", "", 0, 100);
    LIMN_FIELD(hips, "weight of the velocity of the hips", "", 0, 100);
    LIMN_FIELD(response, "time constant with which it wants to change its speed", "s", 0.02, 5);
    LIMN_FIELD(acceleration, "largest that it wants", "m/s2", 0.1, 1000);
    LIMN_FIELD(turn_speed, "fastest turn that it wants", "rad/s", 0.05, 20);
    LIMN_FIELD(
        steer, "fastest turn added to that of the clips, toward the wanted path", "rad/s", 0, 10);
    LIMN_FIELD(
        pace, "share by which clips play faster or slower, to go as fast as is wanted", "", 0, 0.5);
}

/// What a foot shows, and what it is off the clip's foot. A planted foot only rolls over its
/// heel and its ball, whatever the root does; it gives up what it is off when it flies.
struct MatchFoot {
    Vec3 place = {0, 0, 0};
    Quat rotation = {1, 0, 0, 0};
    Vec3 velocity = {0, 0, 0};
    Vec3 spin = {0, 0, 0};
    Vec3 aim = {0, 0, 0};
    InertialOffset shift{};
    InertialOffset turn{};
    float anchor_yaw = 0.0f;
    float clock = 0.0f;
    float hold = 0.0f;
    float arc = 0.0f;
    std::uint32_t planted = 0;
};

LIMN_FIELDS(MatchFoot) {
    LIMN_FIELD(place, "of the ball, in the space of the Transform's parent", "m");
    LIMN_FIELD(rotation, "of the ankle there");
    LIMN_FIELD(velocity, "of the place", "m/s");
    LIMN_FIELD(spin, "its rotation vector per time", "rad/s");
    LIMN_FIELD(aim, "place of the clip's foot", "m");
    LIMN_FIELD(shift, "what the place was off the clip's");
    LIMN_FIELD(turn, "what the rotation was off the clip's");
    LIMN_FIELD(anchor_yaw, "of a planted foot: turn from the space of the clip", "rad");
    LIMN_FIELD(clock, "since `shift` and `turn` were measured", "s");
    LIMN_FIELD(hold, "how much it pulls the hips where the leg is too short", "", 0, 1);
    LIMN_FIELD(arc, "height of its way to the foot of the clip", "m");
    LIMN_FIELD(planted, "1: on the ground; 2: pulled off it before the clip lifts it", "", 0, 2);
}

/// What a MotionMatch plays: all that a snapshot needs to continue in the middle of a transition.
struct MotionMatchState {
    std::uint32_t started = 0;
    std::uint32_t clip = 0;
    float time = 0.0f;
    float since_search = 0.0f;
    float clock = 0.0f;
    std::uint32_t blending = 0;
    std::uint32_t cut = 0;
    float cost = 0.0f;
    std::uint32_t transitions = 0;
    std::vector<InertialOffset> turns{};
    std::vector<InertialOffset> shifts{};
    Vec2 drift = {0, 0};
    float drift_turn = 0.0f;
    float steering = 0.0f;
    float steer_aim = 0.0f;
    float pace = 1.0f;
    float pace_aim = 1.0f;
    Vec2 velocity = {0, 0};
    float turn = 0.0f;
    Vec3 root = {0, 0, 0};
    Vec2 drive = {0, 0};
    float drive_turn = 0.0f;
    std::uint32_t away = 0;
    std::array<MatchFoot, 2> feet{};
};

LIMN_FIELDS(MotionMatchState) {
    LIMN_FIELD(started, "1 after the first search", "", 0, 1);
    LIMN_FIELD(clip, "index of the clip; takes of a walk come after the clips of the level");
    LIMN_FIELD(time, "in the clip", "s");
    LIMN_FIELD(since_search, "since the last search", "s");
    LIMN_FIELD(clock, "since the last transition", "s");
    LIMN_FIELD(blending, "1 in a transition", "", 0, 1);
    LIMN_FIELD(cut, "1: the last step changed the pose without a blend", "", 0, 1);
    LIMN_FIELD(cost, "squared distance of what plays from what is wanted, at the last search");
    LIMN_FIELD(transitions, "that it has made");
    LIMN_FIELD(turns, "rotation offset of each joint that clips animate");
    LIMN_FIELD(shifts, "offset of each joint that clips move");
    LIMN_FIELD(drift, "velocity that a transition keeps at first, in its own space", "m/s");
    LIMN_FIELD(drift_turn, "likewise", "rad/s");
    LIMN_FIELD(steering, "turn that is added to the clip's", "rad/s");
    LIMN_FIELD(steer_aim, "what it tends to", "rad/s");
    LIMN_FIELD(pace, "at which the clip plays, 1: as it was recorded");
    LIMN_FIELD(pace_aim, "what it tends to");
    LIMN_FIELD(velocity, "of the Transform, x and z", "m/s");
    LIMN_FIELD(turn, "likewise", "rad/s");
    LIMN_FIELD(root, "where the Transform was left", "m");
    LIMN_FIELD(drive, "velocity with which a motor moves it next, in its own space", "m/s");
    LIMN_FIELD(drive_turn, "likewise", "rad/s");
    LIMN_FIELD(away, "1: its Walk and its MotorPose pose it", "", 0, 1);
    LIMN_FIELD(feet, "left and right");
}

/// Not copied with a prefab: an instance has no history.
template <>
struct ComponentTraits<MotionMatchState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

/// What a joint showed in the last two steps, and what it is off the pose that it tends to. Feet:
/// in the space of the character; other joints: in that of their parent.
struct HandoverJoint {
    Quat rotation = {1, 0, 0, 0};
    Vec3 place = {0, 0, 0};
    Quat last_rotation = {1, 0, 0, 0};
    Vec3 last_place = {0, 0, 0};
    Quat target_rotation = {1, 0, 0, 0};
    Vec3 target_place = {0, 0, 0};
    InertialOffset turn{};
    InertialOffset shift{};
};

LIMN_FIELDS(HandoverJoint) {
    LIMN_FIELD(rotation, "that it showed in the last step");
    LIMN_FIELD(place, "likewise", "m");
    LIMN_FIELD(last_rotation, "that it showed in the step before");
    LIMN_FIELD(last_place, "likewise", "m");
    LIMN_FIELD(target_rotation, "of the new pose, in the step of the handover");
    LIMN_FIELD(target_place, "likewise", "m");
    LIMN_FIELD(turn, "what the rotation was off the new pose");
    LIMN_FIELD(shift, "what the place was off it");
}

enum class HandoverStage : std::uint32_t {
    None,     ///< shows the pose as it is
    Measure,  ///< goes on as before for a step, in which the new pose's velocity is measured
    Fade,     ///< the offset decays
};

/// State of a MotionMatch with a CharacterMotor and a Walk: how its pose passes from one to the
/// other.
struct MatchHandover {
    std::uint32_t away = 0;
    HandoverStage stage = HandoverStage::None;
    float clock = 0.0f;
    std::vector<HandoverJoint> joints{};
    std::array<HandoverJoint, 2> feet{};
};

LIMN_FIELDS(MatchHandover) {
    LIMN_FIELD(away, "1: it shows the pose of its Walk", "", 0, 1);
    LIMN_FIELD(stage, .doc = "of a handover", .values = "none measure fade");
    LIMN_FIELD(clock, "since the offset was measured", "s");
    LIMN_FIELD(joints, "all of the skeleton");
    LIMN_FIELD(feet, "left and right ankle");
}

/// Not copied with a prefab: an instance has no history.
template <>
struct ComponentTraits<MatchHandover> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

/// The pose of a MotionMatch in this step, for update_poses; never saved.
struct MatchPose {
    LocalPose pose{};
    std::vector<std::uint16_t> turning{};  ///< joints whose rotations count
    std::vector<std::uint16_t> moving{};   ///< joints whose translations count
};
template <>
struct ComponentTraits<MatchPose> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
