#pragma once

#include "content/game/walker.h"
#include "ecs/commands.h"
#include "ecs/components/camera.h"
#include "ecs/components/input.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/water/water_query.h"

#include <span>

namespace limn {

// A walking character that can wade and swim.
//
// Collision with upright boxes (Footing): the highest top not more than a step above the feet is
// the ground; higher boxes push back in the shorter direction. In water it walks more slowly with
// depth and falls more slowly; where it cannot stand it swims with its eyes above the surface, and
// dives while `move.y` is negative; where it stands deep enough it ducks. Tilted boxes count
// as upright.

/// A Footing in world space.
struct Ground {
    Affine local_from_world;
    Vec3 half{};
};
[[nodiscard]] Ground make_ground(const Footing& footing, const Affine& world);

/// Gives each Walker its state.
void add_walker_states(Query<const Walker, Without<WalkerState>> walkers, Commands commands);

/// Advances every Walker and its camera by a step; without input if its camera is not active.
/// The actions are walk_left, walk_right, walk_forward, walk_back, dive, rise and run. After
/// everything that moves water, before update_transforms.
void update_walkers(
    Query<const Walker, WalkerState, Transform, Without<Parent>> walkers,
    Query<const Footing, const WorldTransform> footings, WaterQuery waters,
    Query<const Camera> cameras, Query<Transform> transforms, Res<const Input> input,
    Res<const FrameTime> time);

/// Advances one walker by `step` [s]; `position` is between its feet.
void step_walker(
    std::span<const Ground> grounds, std::span<const WaterSurface> waters, const MoveInput& input,
    float step, const Walker& settings, WalkerState& walker, Vec3& position);

}  // namespace limn
