#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/skeleton.h"

#include <span>

namespace limn {

// Discontinuities of clips: keys with step interpolation, segments that are instantaneous, and the
// end of a loop whose last key differs from its first. What jumps within a step has no velocity,
// and frames between two steps show one side of the jump or the other.

/// The part of a clip that a player plays in one step.
struct ClipStep {
    float from = 0;  ///< [s]; outside 0 .. duration where a loop starts over
    float to = 0;    ///< [s], within 0 .. duration
    bool loops = false;
};

/// What `player`, a ClipPlayer or a MorphAnimation, played in the last step, of `step` [s].
template <typename Player>
[[nodiscard]] ClipStep clip_step(const Player& player, float step) {
    return {player.time - player.speed * step, player.time, player.loop};
}

/// Whether something may jump in `step`: much faster than finding what.
[[nodiscard]] bool may_jump(const ClipData& clip, const ClipStep& step);

/// Finds what jumps in `step`: lowers the times of its joints, unless `joints` is empty, and of its
/// weights, in fractions of a step; kNoJump: none. The clip must fit.
void find_clip_jumps(
    const ClipData& clip, const ClipStep& step, std::span<float> joints, std::span<float> weights);

/// A joint jumps with its parent. Fills pose.jumps, and sets the previous matrix of joints that
/// jumped to the current one.
void apply_joint_jumps(const SkeletonData& skeleton, std::span<float> at, Pose& pose);
/// Likewise for morph weights.
void apply_weight_jumps(std::span<const float> at, MorphWeights& morph);

/// The earliest jump of a character; kNoJump: none.
[[nodiscard]] float first_jump(const Pose* pose, const MorphWeights* morph);

}  // namespace limn
