#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/camera.h"
#include "ecs/components/crowd_pose.h"
#include "ecs/components/surface.h"
#include "ecs/components/surface_binding.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/animation/crowd_library.h"

#include <cstdint>

namespace limn {

// Crowds: compressed copies of their clips, how often each character is posed, and how many of its
// joints. update_poses() poses those that are due.

/// Adds a state to every CrowdPose without one.
void add_crowd_poses(Query<const CrowdPose, Without<CrowdPoseState>> crowds, Commands commands);

/// Compresses clips that crowds play for the first time, and makes rigs of as many joints as they
/// need.
void prepare_crowd_clips(
    Query<const CrowdPose, const Skeleton, const ClipPlayer, Optional<const CrowdPoseState>> crowds,
    Res<const Assets> assets, Res<CrowdLibrary> library);

/// Seconds over which a crowd's character fades from one clip to another.
inline constexpr float kCrowdFade = 0.3f;

/// Starts a fade where the clip of a player was changed, and advances those that go on: the last
/// pose of the old clip is kept until then. After advance_clips.
void fade_crowd_clips(Query<const ClipPlayer, CrowdPoseState> crowds, Res<const FrameTime> time);

/// Steps from one pose to the next at a distance: 1, 2 or 4. It changes 10 % beyond a border, not
/// at it, so that characters near one do not alternate.
[[nodiscard]] std::uint32_t
choose_pose_interval(const CrowdPose& crowd, float distance, std::uint32_t current);

/// Chooses the intervals by the distance from the active camera.
void choose_pose_rates(
    Query<const CrowdPose, const WorldTransform, CrowdPoseState> crowds,
    Query<const Camera, const WorldTransform> cameras);

/// Finds how many joints the meshes on each character need, and what is attached to them
/// (pose_levels.h). A pose that lacks some gets them at once. After the meshes were chosen.
void choose_pose_joints(
    Query<const CrowdPose, const Skeleton, CrowdPoseState, Pose> crowds,
    Query<const Deformed, const MeshInstance> meshes,
    Query<const Deformed, const ControlSurface> surfaces, Query<const JointAttachment> attachments,
    Res<const Assets> assets, Res<CrowdLibrary> library);

}  // namespace limn
