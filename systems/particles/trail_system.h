#pragma once

#include "ecs/commands.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "ecs/components/trail.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

// Histories of positions that trails are drawn from (engine.trail). A point is left at every
// spacing of the path, not at every step, and with its own age: so a trail is the same at every
// frame rate. Between steps the path is a parabola through the last three positions, which is
// straightened where it turns sharply. Memory is reused: a trail in flight allocates nothing.

/// Adds a TrailState to every Trail that lacks one. Before update_trails, with a sync point in
/// between.
void add_trail_states(Query<const Trail, Without<TrailState>> trails, Commands commands);

/// A step of all trails. After update_particles and update_transforms.
void update_trails(
    Query<const Trail, TrailState> trails, Query<const ParticlePool> pools,
    Query<const WorldTransform, const PreviousWorldTransform> transforms,
    Res<const FrameTime> time);

// ---- parts of the above ----

/// Ages all points and heads by `dt`, and drops those beyond the trail's length and life but the
/// first, between which and the others the trail ends.
void age_trail(TrailState& state, const Trail& trail, float dt);

/// A new strand that begins at `start`.
TrailStrand& add_strand(TrailState& state, const TrailPoint& start);

/// Moves the head to `to` in `dt`. Returns false, and ends the strand, if `to` is not finite or a
/// jump away.
bool extend_strand(
    TrailState& state, TrailStrand& strand, const Trail& trail, const TrailPoint& to, float dt);

}  // namespace limn
