#pragma once

#include "ecs/components/skeleton.h"

#include <cstddef>
#include <span>

namespace limn {

// Evaluation of clips between keys (char.pose-eval).

/// A key interval and the position within it, 0 .. 1.
struct KeyInterval {
    std::size_t first = 0;
    float u = 0.0f;
};

/// The interval that contains `t` in `times`, which increase (anim.key-lookup). Clamped to the
/// first key (also for NaN) and the last one. A single key: that key, u = 0.
[[nodiscard]] KeyInterval find_keys(std::span<const float> times, float t);

/// `time` [s] mapped into a clip of this duration: wrapped, or clamped at both ends. 0 if `time` is
/// not finite or the clip has no duration.
[[nodiscard]] float clip_time(float duration, float time, bool loops);

/// Writes the joints and morph weights animated by the clip at `time` [s], clamped to the first and
/// last key of each sheet. Other joints keep their values, usually the rest pose. `pose` and
/// `weights` must have all joints and weights of the clip. Rotations are normalized.
void sample_clip(const ClipData& clip, float time, LocalPose& pose, std::span<float> weights);

/// The same for its morph weights only.
void sample_clip_weights(const ClipData& clip, float time, std::span<float> weights);

/// Weight below which a morph animation is ignored.
inline constexpr float kMinMorphWeight = 1e-4f;

/// Adds the clip's morph weights at `time` [s], times `weight`, where they exceed kMinMorphWeight
/// (char.morph-anim). Curves with a single key are ignored.
void add_morph_weights(const ClipData& clip, float time, float weight, std::span<float> weights);

/// skeleton_from_joint of each joint: the product of all matrices from the root
/// (char.local-global). `matrices` has one entry per joint.
void compute_joint_matrices(
    const SkeletonData& skeleton, const LocalPose& pose, std::span<Affine> matrices);

/// Local pose and morph weights of a skeleton in `clip`, otherwise like evaluate_pose().
void sample_pose(
    const SkeletonData& skeleton, const ClipData* clip, float time, LocalPose& pose,
    std::span<float> weights);

/// Clip time of `player`, a ClipPlayer or a MorphAnimation, after `step` [s]: wraps or holds at the
/// end; always within 0 .. duration, whatever the values of its fields.
template <typename Player>
[[nodiscard]] float step_clip_time(const Player& player, float duration, float step) {
    return clip_time(duration, player.time + player.speed * step, player.loop);
}

}  // namespace limn
