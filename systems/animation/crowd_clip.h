#pragma once

#include "ecs/base/result.h"
#include "ecs/components/skeleton.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Clips of crowds: small, and as fast to sample at any time as at the next one, because they have
// uniform frames and nothing is kept per character. A rotation has 48 bits (smallest three): the
// largest of its four components follows from the others, which are integers
//
//     word 0: the first one, odd where bit 0 of the index of the largest one is set
//     word 1: the second one, odd where bit 1 of that index is set
//     word 2: the third one, odd where the largest one is negative
//
// so that the quaternions of neighboring frames are always in the same hemisphere. Joints that do
// not move are stored once. A frame has all words 0 of its joints, then all words 1 and all words
// 2, as vectors of joints are loaded.
// After N. Frechette, "Animation Compression: Table of Contents" (2016).
// Techniques: char.clip-layout

/// Length of a row of joints in vectors of at least four.
[[nodiscard]] constexpr std::size_t pose_stride(std::size_t joints) {
    return (joints + 3) / 4 * 4;
}

/// Elements after the last one that vectors may read.
inline constexpr std::size_t kPosePadding = 16;
/// Characters processed together, in the lanes of vectors.
inline constexpr std::size_t kPoseLanes = 16;

/// Consecutive animated joints.
struct TrackRun {
    std::uint16_t first = 0;  ///< joint
    std::uint16_t count = 0;
    std::uint32_t track = 0;  ///< of the first: column of the frames
};

/// Rotations or translations of all joints.
struct CrowdTracks {
    std::vector<TrackRun> runs;         ///< ascending by joint
    std::size_t animated = 0;           ///< tracks in frames
    std::vector<std::uint16_t> frames;  ///< each: three rows of all tracks; then padding
    std::vector<float> constants;  ///< rows as in PoseRows, then padding; empty if all are animated
    std::vector<float> ranges;     ///< of animated translations, six rows: smallest x y z [m], then
                                   ///< what one step of a word is [m]; then padding
};

/// Smallest cosine between a quaternion and that of the next frame: between them the length is then
/// so close to 1 that it needs no square root.
inline constexpr float kMinFrameCosine = 0.9f;

/// A clip of one skeleton, without scales and morph weights.
struct CrowdClip {
    std::size_t joints = 0;
    std::size_t frames = 1;
    float duration = 0.0f;  ///< [s]
    float rate = 0.0f;      ///< frames per second; 0: a single frame
    CrowdTracks rotations;
    CrowdTracks translations;
    float error = 0.0f;  ///< measured maximum, see CrowdClipLimits [m]
};

/// Error that a clip may have, at points at `shell` around each joint, in the character's space:
/// errors of parents are those of their children too. For a character two meters tall.
struct CrowdClipLimits {
    float tolerance = 1e-3f;  ///< [m]
    float shell = 0.1f;       ///< [m]
};

/// The same for a skeleton of any size, by the distances of its joints at rest.
[[nodiscard]] CrowdClipLimits scale_limits(const SkeletonData& skeleton);

/// The fewest frames whose error is within the limits. Fails for a clip that is not for this
/// skeleton, has moving scales, or jumps. Morph weights are left out.
[[nodiscard]] Result<CrowdClip>
make_crowd_clip(const SkeletonData& skeleton, const ClipData& clip, const CrowdClipLimits& limits);

/// Largest distance between points at `shell` around each joint in both poses.
[[nodiscard]] float shell_error(std::span<const Affine> a, std::span<const Affine> b, float shell);

/// Bytes of frames, constants, ranges and runs.
[[nodiscard]] std::size_t crowd_clip_bytes(const CrowdClip& clip);

using PackedRotation = std::array<std::uint16_t, 3>;
/// Of a unit quaternion, or of its negative.
[[nodiscard]] PackedRotation pack_rotation(const Quat& rotation);
/// The quaternion, kPackedMax sqrt(2) long.
[[nodiscard]] Quat unpack_rotation(const PackedRotation& words);

/// Largest value of a component that is not the largest one; sqrt(2) of it is the length of an
/// unpacked quaternion.
inline constexpr float kPackedMax = 32766.0f;

}  // namespace limn
