#pragma once

#include "ecs/components/skeleton.h"

#include <array>
#include <cstddef>
#include <span>

namespace limn {

// How the creature goes. Where its feet are is given - on the ground they go back as fast as the
// body goes forward, in the air they follow a flight path - and the legs are solved for it
// (char.walk-cycle): the last bone has a given slope, the two above it are a triangle. The trunk
// bends in the plane of symmetry alone, so that feet stay where they are put.
// Footfalls after E. Muybridge, "Animals in Motion" (1899): a walk sets down left hind, left fore,
// right hind, right fore, a quarter of the cycle apart; a transverse gallop both hind feet, then
// both fore feet, then none.

enum class Leg : std::uint8_t { LeftFront, RightFront, LeftHind, RightHind };
inline constexpr std::size_t kLegs = 4;

/// Lengths are those of a creature of 0.45 m.
struct Gait {
    const char* name;
    float period;                        ///< of a cycle [s]
    float stride;                        ///< that the body goes in a cycle [m]
    float duty;                          ///< share of the cycle in which a foot stands; 1: always
    std::array<float, kLegs> touchdown;  ///< when in the cycle each foot is set down, 0 .. 1
    float lift;                          ///< of a foot in the air [m]
    float drop;                          ///< of the body below its rest [m]
    float bob;                           ///< of the body up and down [m]
    float bobs;                          ///< in a cycle
    float top;                           ///< when in the cycle it is highest
    float flex;                          ///< of the spine to both sides of straight [rad]
    float crouch;                        ///< of the neck forward [rad]
    float tail;                          ///< swing to both sides [rad]
    int breaths;                         ///< in a cycle
};

/// "idle", "walk", "run".
[[nodiscard]] std::span<const Gait> creature_gaits();

/// Forward [m/s] of a creature of 0.45 m.
[[nodiscard]] inline float gait_speed(const Gait& gait) {
    return gait.stride / gait.period;
}

/// How far through its stand a foot is, 0 .. 1; less than 0: it is in the air.
[[nodiscard]] float stand_share(const Gait& gait, Leg leg, float phase);

/// Height of a foot on its way from lift (s = 0) to touchdown (1), 0 .. 2: up in a third of the
/// way, down in the rest (char.foot-flight).
[[nodiscard]] float foot_flight(float s);

/// The clip of a creature `scale` as large; it ends as it begins. Moves all joints, and the morph
/// weights 0 (blink) and 1 (breath).
[[nodiscard]] ClipData make_gait_clip(const Gait& gait, float scale);

}  // namespace limn
