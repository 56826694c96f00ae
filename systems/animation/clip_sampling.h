#pragma once

#include "ecs/components/skeleton.h"

#include <cstddef>
#include <span>

namespace limn {

// Poses between the keys of a clip (char.pose-eval).

/// Two neighboring keys and how far from the first to the second: 0 .. 1.
struct KeyPlace {
    std::size_t first = 0;
    float u = 0.0f;
};

/// The keys around `t` in `times`, which grow (anim.key-lookup). Before the first key, and for NaN:
/// there; from the last on: its end. A single key: itself, u = 0.
[[nodiscard]] KeyPlace find_keys(std::span<const float> times, float t);

/// Where a clip of this duration is at `time` [s]: begun anew after the end, or held at both ends.
/// Not finite, or no duration: 0.
[[nodiscard]] float clip_time(float duration, float time, bool loops);

/// Writes the joints that the clip moves, and its morph weights, as they are at `time` [s]; before
/// the first and after the last key of a sheet, that key. `pose` holds the others already, mostly
/// the skeleton's rest; all joints of the clip are in it, all weights in `weights`. Rotations come
/// out with length 1.
void sample_clip(const ClipData& clip, float time, LocalPose& pose, std::span<float> weights);

/// Below it a morph animation does nothing.
inline constexpr float kLeastMorph = 1e-4f;

/// Adds what the clip's morph weights are at `time` [s], times `weight`, where they are more than
/// kLeastMorph (char.morph-anim). Curves of a single key do nothing.
void add_morph_weights(const ClipData& clip, float time, float weight, std::span<float> weights);

/// skeleton_from_joint of each joint: the product of all matrices from the root on
/// (char.local-global). `matrices` has an entry a joint.
void find_joint_matrices(
    const SkeletonData& skeleton, const LocalPose& pose, std::span<Affine> matrices);

}  // namespace limn
