#pragma once

#include "ecs/components/input.h"
#include "ecs/components/transform.h"
#include "ecs/components/walker.h"
#include "systems/water/water_query.h"

#include <span>

namespace limn {

class World;

// Somebody on foot, who goes down steps into the water until there is no ground to stand on.
//
// Upright boxes (Footing) carry and stop: the highest top that is not more than a step above the
// feet is the ground, what is higher pushes back the shorter way. In water it is slower the deeper
// it stands, and falls slower; where the water is deeper than it can stand in it swims with its
// eyes above the surface, and dives while Input::move.y is down; where it stands deep enough it
// ducks. Boxes that lean count as upright.

/// A Footing where it is.
struct Ground {
    Affine local_from_world;
    Vec3 half{};
};
[[nodiscard]] Ground make_ground(const Footing& footing, const Affine& world);

/// Moves every Walker by a step, and its camera; one whose camera is not active stands still. After
/// what moves the water, before update_transforms.
void update_walkers(World& world);

/// One step [s]; `position` is between its feet.
void step_walker(
    std::span<const Ground> grounds, std::span<const WaterSurface> waters, const Input& input,
    float step, Walker& walker, Vec3& position);

}  // namespace limn
