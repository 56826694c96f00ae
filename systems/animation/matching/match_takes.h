#pragma once

#include "ecs/components/skeleton.h"
#include "ecs/components/walk.h"
#include "systems/animation/graph/root_motion.h"

#include <vector>

namespace limn {

// A dance card: what actors are asked to do where motion is captured for motion matching. Here a
// generated walk performs it: for each of three speeds starts and stops, turns at a corner, turns
// out of standing, curves; changes of speed, turns on the spot, steps sideways and backward.
// Techniques: char.motion-select

inline constexpr float kTakeKey = 1.0f / 60.0f;  ///< between keys of a take [s]

/// A performance, in the space of its stage.
struct MatchTake {
    ClipData clip{};                 ///< hips and all below in the stage's space; contacts of feet
    std::vector<GroundMove> root{};  ///< where the character is at each key, from the origin
};

/// Some three minutes, cut where the walk goes wrong. Only the joints that a walk moves have keys.
/// Without legs: none.
[[nodiscard]] std::vector<MatchTake>
make_match_takes(const SkeletonData& skeleton, const Walk& walk);

}  // namespace limn
