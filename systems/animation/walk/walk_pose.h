#pragma once

#include "ecs/components/skeleton.h"
#include "ecs/components/walk.h"
#include "systems/animation/walk/walk_body.h"

namespace limn {

// The pose of a walk: hips as high as both legs reach, legs in closed form, feet that roll over
// heels and toes, a back that turns against the hips, arms that swing against the legs.
// Techniques: char.walk-control, char.walk-cycle

/// Changes the legs, hips, back, head and arms of `pose`; what else the clip does remains.
void apply_walk(
    const SkeletonData& skeleton, const Walk& walk, const WalkState& state, const WalkBody& body,
    LocalPose& pose);

/// Where the ankle is, and how the foot has turned from rest, on its heel or on its toes.
struct FootPlace {
    Vec3 ankle = {0, 0, 0};  ///< in the space of the character [m]
    Quat rotation = {1, 0, 0, 0};
    Quat toes = {1, 0, 0, 0};  ///< level while the heel is up
};
[[nodiscard]] FootPlace
find_foot_place(const WalkLeg& leg, const Vec3& place, float heading, float pitch);

/// The least of three numbers, smoothly: lower by at most `softness` log(3).
[[nodiscard]] float smooth_min(float a, float b, float c, float softness);

}  // namespace limn
