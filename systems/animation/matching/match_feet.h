#pragma once

#include "ecs/components/motion_match.h"
#include "ecs/components/skeleton.h"
#include "ecs/components/transform.h"
#include "systems/animation/graph/root_motion.h"
#include "systems/animation/walk/walk_body.h"

#include <array>

namespace limn {

// Feet of a character whose clips change in the middle of steps. A foot that the clip has on the
// ground turns as in the clip, over its heel or its ball, whichever is lower, and that point stays;
// what that makes it be off the clip decays while it flies.
// After L. Kovar, J. Schreiner, M. Gleicher, "Footskate Cleanup for Motion Capture Editing" (2002),
// and D. Holden, "Inertialization Transition Cost" (2022).
// Techniques: char.blend

/// A foot: its ball, or its ankle where it has no toes, and the rotation of the ankle.
struct FootPoint {
    Vec3 place = {0, 0, 0};  ///< [m]
    Quat rotation = {1, 0, 0, 0};
};

/// Ball and heel of the foot in the space of the ankle [m].
[[nodiscard]] Vec3 ball_offset(const SkeletonData& skeleton, const WalkLeg& leg);
[[nodiscard]] Vec3 heel_offset(const SkeletonData& skeleton, const WalkLeg& leg);

/// A foot of a pose, in the space of the skeleton.
[[nodiscard]] FootPoint
find_foot(const SkeletonData& skeleton, const WalkLeg& leg, const LocalPose& pose);

struct FootRate {
    Vec3 velocity = {0, 0, 0};  ///< [m/s]
    Vec3 spin = {0, 0, 0};      ///< rotation vector per time [rad/s]
};

/// Rate of a foot that was at `from` and is at `to`, both in the space of `at`, after `dt` [s].
[[nodiscard]] FootRate
rate_between(const FootPoint& from, const FootPoint& to, float dt, const Transform& at);

/// Where the clip has a foot now.
struct FootAim {
    FootPoint local{};      ///< in the space of the root
    GroundMove root{};      ///< of the clip
    Vec3 heel = {0, 0, 0};  ///< from the ball, in the space of the ankle [m]
    float sole = 0.0f;      ///< height of the ball of a flat foot [m]
    bool stands = false;    ///< on the ground
    bool contact = false;   ///< likewise, and the shown foot has to stand as well
    Vec3 hip = {0, 0, 0};   ///< where the leg begins, in the space of the root [m]
    Vec3 ball = {0, 0, 0};  ///< in the space of the ankle [m]
    float leg = 1.0f;       ///< length of the leg [m]
};

/// What the foot was off the clip's, from now on; also after the clip has changed. `rate`: of the
/// clip's foot.
void capture_foot(const FootAim& aim, const Transform& at, const FootRate& rate, MatchFoot& foot);

/// Shows the foot after a step of `dt` [s], 0: where it is; `reach` [m]: farther from the clip's
/// foot it leaves the ground. `blend`: time of decay [s].
void step_foot(
    const FootAim& aim, const Transform& at, float blend, float reach, float dt, MatchFoot& foot);

/// The foot exactly as in the clip.
void place_foot(const FootAim& aim, const Transform& at, MatchFoot& foot);

/// Bends the legs so that the feet are where they are shown, and lowers the hips where a leg is too
/// short. `at`: of the character.
void apply_match_feet(
    const SkeletonData& skeleton, const WalkBody& body, const std::array<MatchFoot, 2>& feet,
    const Transform& at, LocalPose& pose);

}  // namespace limn
