#pragma once

#include "ecs/commands.h"
#include "ecs/components/key_track.h"
#include "ecs/query.h"

namespace limn {

class World;

/// Adds the state to new tracks. Logs those that are invalid, which change nothing.
void add_key_track_states(Query<const KeyTrack, Without<KeyTrackState>> tracks, Commands commands);

/// Checks changed tracks again.
void prepare_key_tracks(Query<const KeyTrack, KeyTrackState, Changed<KeyTrack>> tracks);

/// Sets the fields that tracks animate to their values at the end of this step, clamped to their
/// ranges, unless the entity lacks the component. Exclusive: writes any component.
void update_key_tracks(World& world);

}  // namespace limn
