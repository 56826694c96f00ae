#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/pose_keys.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

// Poses set by hand (char.fk-keypose): keys become a clip when they change, which update_poses
// samples.

/// Adds the state to new keys. Logs those that are invalid, which leave the rest pose.
void add_pose_keys_states(
    Query<const PoseKeys, const Skeleton, Without<PoseKeysState>> keyed, Res<const Assets> assets,
    Commands commands);

/// Removes the state of keys that were removed.
void release_pose_keys(Query<const PoseKeysState, Without<PoseKeys>> released, Commands commands);

/// Makes the clips of changed keys again.
void prepare_pose_keys(
    Query<const PoseKeys, const Skeleton, PoseKeysState, Changed<PoseKeys>> keyed,
    Res<const Assets> assets);

/// Advances the ClipPlayer of every character with keys by one step, within their duration. One
/// that stands still may be beyond the last key, where the next one is to be set.
void advance_pose_keys(Query<const PoseKeysState, ClipPlayer> players, Res<const FrameTime> time);

}  // namespace limn
