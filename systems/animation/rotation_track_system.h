#pragma once

#include "ecs/commands.h"
#include "ecs/components/rotation_track.h"
#include "ecs/components/step_jumps.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Aligns the keys and finds times and control points.
[[nodiscard]] RotationTrackState make_rotation_track(const RotationTrack& track);

/// Rotation at `time` [s]; the identity without keys.
[[nodiscard]] Quat
rotation_at(const RotationTrack& track, const RotationTrackState& state, double time);

/// Adds the state to new tracks.
void add_rotation_track_states(
    Query<const RotationTrack, Without<RotationTrackState>> tracks, Commands commands);

/// Recreates the state of changed tracks.
void prepare_rotation_tracks(
    Query<const RotationTrack, RotationTrackState, Changed<RotationTrack>> tracks);

void update_rotation_tracks(
    Query<const RotationTrack, const RotationTrackState, Transform> tracks,
    Res<const FrameTime> time, OptionalRes<StepJumps> jumps);

}  // namespace limn
