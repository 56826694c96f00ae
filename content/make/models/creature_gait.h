#pragma once

#include "ecs/components/skeleton.h"

#include <array>
#include <cstddef>
#include <span>

namespace limn {

// Gaits of the creature. The paths of its feet are given - on the ground they move back at the
// speed of the body, in the air they follow foot_flight.h - and the legs are solved by inverse
// kinematics (char.walk-cycle): the last bone has a given slope, the two above it form a triangle.
// The trunk bends in the plane of symmetry only, so that planted feet do not slide. Footfalls after
// E. Muybridge, "Animals in Motion" (1899): a walk sets down left hind, left fore, right hind,
// right fore, a quarter of the cycle apart; a trot diagonal pairs; a transverse gallop both hind
// feet, then both fore feet, then none.

enum class Leg : std::uint8_t { LeftFront, RightFront, LeftHind, RightHind };
inline constexpr std::size_t kLegs = 4;

/// Lengths are for a creature of 0.45 m.
struct Gait {
    const char* name;
    float period;                        ///< duration of a cycle [s]
    float stride;                        ///< distance per cycle [m]
    float duty;                          ///< fraction of the cycle in stance; 1: always
    std::array<float, kLegs> touchdown;  ///< phase at which each foot touches down, 0 .. 1
    float lift;                          ///< maximum height of a foot in the air [m]
    float drop;                          ///< of the body below its rest height [m]
    float bob;                           ///< vertical amplitude of the body [m]
    float bobs;                          ///< vertical oscillations per cycle
    float top;                           ///< phase at which the body is highest
    float flex;                          ///< bending amplitude of the spine [rad]
    float crouch;                        ///< forward pitch of the neck [rad]
    float tail;                          ///< swing amplitude of the tail [rad]
    int breaths;                         ///< per cycle
};

/// "idle", "walk", "trot", "run".
[[nodiscard]] std::span<const Gait> creature_gaits();

/// Forward speed of a creature of 0.45 m [m/s].
[[nodiscard]] inline float gait_speed(const Gait& gait) {
    return gait.stride / gait.period;
}

/// Progress of a foot through its stance, 0 .. 1; < 0 while it is in the air.
[[nodiscard]] float stance_progress(const Gait& gait, Leg leg, float phase);

/// A looping clip for a creature scaled by `scale`. Animates all joints, and the morph weights 0
/// (blink) and 1 (breath). Its contacts are the stances of the feet; one that lasts beyond the end
/// of the cycle is continued by another one from its beginning.
[[nodiscard]] ClipData make_gait_clip(const Gait& gait, float scale);

}  // namespace limn
