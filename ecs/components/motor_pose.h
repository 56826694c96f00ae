#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <array>
#include <cstdint>

namespace limn {

// How a character looks that a CharacterMotor moves: its legs give way when it lands, by as much as
// it was fast; arms and legs hang, reach and swim. All of it is procedural, and each part has a
// weight with a continuous rate, so that nothing jumps.
// Techniques: char.motion-select

/// With a Walk and a CharacterMotor: jumps, falls, lands, wades, swims, pushes, carries and throws.
/// The Walk must not move the root.
struct MotorPose {
    float crouch = 0.24f;
    float give = 10.0f;
    float deepest = 0.5f;
    float tuck = 0.28f;
    float arms = 1.0f;
    float stroke = 0.75f;
};

LIMN_FIELDS(MotorPose) {
    LIMN_FIELD(
        crouch, "by which hips sink before a jump on the spot; less in a run", "leg lengths", 0,
        0.6);
    LIMN_FIELD(give, "rate of the knees after landings; less: softer and deeper", "1/s", 1, 100);
    LIMN_FIELD(deepest, "that hips ever sink after landings", "leg lengths", 0, 0.7);
    LIMN_FIELD(tuck, "height to which feet are drawn up in a jump", "leg lengths", 0, 0.7);
    LIMN_FIELD(arms, "from the arms of the walk, 0, to those of what it does, 1", "", 0, 1);
    LIMN_FIELD(stroke, "strokes per second of a swim at full speed", "Hz", 0.05, 5);
}

/// A number that follows another one like a critically damped spring.
struct EasedValue {
    float value = 0.0f;
    float rate = 0.0f;
};

LIMN_FIELDS(EasedValue) {
    LIMN_FIELD(value, "now");
    LIMN_FIELD(rate, "its derivative", "1/s");
}

/// State of a MotorPose.
struct MotorPoseState {
    EasedValue air{};
    EasedValue fall{};
    EasedValue swim{};
    EasedValue cruise{};
    EasedValue wade{};
    EasedValue push{};
    EasedValue hold{};
    EasedValue fling{};
    EasedValue sink{};
    std::array<float, 2> lifts = {};
    std::array<float, 2> tilts = {};
    std::array<Vec3, 2> hands = {};
    Vec3 root = {0, 0, 0};
    float drop_speed = 0.0f;
    float water = 0.0f;
    float phase = 0.0f;
    std::uint32_t lead = 0;
    std::uint32_t off_ground = 0;
    std::uint32_t holds = 0;
};

LIMN_FIELDS(MotorPoseState) {
    LIMN_FIELD(air, "weight of jumps and falls", "", 0, 1);
    LIMN_FIELD(fall, "from rising, 0, to falling, 1", "", 0, 1);
    LIMN_FIELD(swim, "weight of swimming", "", 0, 1);
    LIMN_FIELD(cruise, "from treading water, 0, to lying in it, 1", "", 0, 1);
    LIMN_FIELD(wade, "weight of wading", "", 0, 1);
    LIMN_FIELD(push, "weight of pushing", "", 0, 1);
    LIMN_FIELD(hold, "weight of carrying", "", 0, 1);
    LIMN_FIELD(fling, "weight of the end of a throw", "", 0, 1);
    LIMN_FIELD(sink, "of the hips", "leg lengths");
    LIMN_FIELD(lifts, "of feet above the ground that they have just touched", "m");
    LIMN_FIELD(tilts, "their pitches likewise", "rad");
    LIMN_FIELD(hands, "what they reach for, in the character's space", "m");
    LIMN_FIELD(root, "position in the last step", "m");
    LIMN_FIELD(drop_speed, "downward, in the last step off the ground", "m/s");
    LIMN_FIELD(water, "depth of the water above the soles", "m");
    LIMN_FIELD(phase, "of the stroke of a swim", "cycles", 0, 1);
    LIMN_FIELD(lead, "foot ahead in a jump: 0 left, 1 right", "", 0, 1);
    LIMN_FIELD(off_ground, "1: falls or swims", "", 0, 1);
    LIMN_FIELD(holds, "1: carries something", "", 0, 1);
}

/// Not copied with a prefab: an instance has no history.
template <>
struct ComponentTraits<MotorPoseState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
