#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/components/skeleton.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace limn {

// A recorded motion: a skeleton and one clip of it, to be edited as poses at a constant rate.

struct SkeletonMotion {
    SkeletonData skeleton;
    ClipData clip;
};

/// Poses of a motion at times k / rate. Joint j of frame f is at f * joints + j.
struct MotionFrames {
    float rate = 30.0f;  ///< frames per second, > 0
    std::size_t joints = 0;
    std::vector<Vec3> translations;  ///< from the parent [m]
    std::vector<Quat> rotations;     ///< unit, in the hemisphere of the previous frame
    std::vector<Vec3> scales;

    [[nodiscard]] std::size_t frames() const { return joints == 0 ? 0 : rotations.size() / joints; }
    [[nodiscard]] float duration() const {
        return frames() < 2 ? 0.0f : static_cast<float>(frames() - 1) / rate;
    }
};

/// The pose of the clip at `time` [s], clamped to its keys; the rest pose where it has none.
[[nodiscard]] LocalPose
sample_motion(const SkeletonData& skeleton, const ClipData& clip, float time);

/// The rate of the clip's keys, where they are equally spaced to 1 %; else 30 [1/s].
[[nodiscard]] float find_motion_rate(const ClipData& clip);

/// Fails with one line where so many poses would not fit into memory.
[[nodiscard]] Status check_pose_count(const SkeletonMotion& motion, float rate);

/// Poses at times 0, 1 / rate, 2 / rate ... up to the duration; at least one (char.mocap-rate).
[[nodiscard]] MotionFrames sample_frames(const SkeletonMotion& motion, float rate);

/// The clip of these frames: keys for what differs from rest in some frame. Contacts and events are
/// those of `like`, up to the duration.
[[nodiscard]] ClipData
make_frames_clip(const SkeletonData& skeleton, const MotionFrames& frames, const ClipData& like);

/// skeleton_from_joint of all joints in frame `frame`.
[[nodiscard]] std::vector<Affine>
find_frame_joints(const SkeletonData& skeleton, const MotionFrames& frames, std::size_t frame);

/// Positions of one joint in all frames, in the space of the skeleton [m].
[[nodiscard]] std::vector<Vec3>
joint_path(const SkeletonData& skeleton, const MotionFrames& frames, std::size_t joint);

/// The same motion with keys at multiples of 1 / rate.
[[nodiscard]] SkeletonMotion resample_motion(const SkeletonMotion& motion, float rate);

}  // namespace limn
