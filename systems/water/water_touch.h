#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/components/water_ripples.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/water/water_query.h"
#include "systems/water/water_ripple_field.h"

#include <vector>

namespace limn {

// What touches the water, as shapes, and what each of them pushes up.
//
// A body is under water as far as it is below the surface that sea and waves make there, and that
// all bodies together have raised: so a boat that rides a swell pushes no rings, and a pool rises
// by what Archimedes says of its level now, not of its level at rest. Its own ripples do not count:
// they are what it makes, and if they did, its hill would push it under and raise the hill. Waves
// shorter than the body do not either; they are as often above as below.
//
// A body with a mesh (TouchShape::Mesh) is an ellipsoid in the bounds of the vertices that each
// joint moves most, where the pose has the joint. All together they displace what the mesh
// encloses; one that is open, or inside out, as much as the ellipsoids hold.

/// A shape in the world; `half` and `offset` in a space that is at `world`.
struct TouchingShape {
    WallShape shape = WallShape::Ball;
    Vec3 half = {0, 0, 0};
    Vec3 offset = {0, 0, 0};
    Affine world;
    float fill = 1;  ///< share of its volume that displaces water
};

/// The ellipsoids of a mesh, by the joints of its skin or, without one, by its bounds.
[[nodiscard]] TouchParts make_touch_parts(const MeshData& mesh, const SkinData* skin);

/// Gives TouchParts to what touches with its mesh, and others when it has another mesh or skin.
/// Before update_water_ripples, with a sync point between.
void add_touch_parts(
    Query<const WaterTouch, const MeshInstance, Optional<const Deformed>, Optional<TouchParts>>
        bodies,
    Res<const Assets> assets, Commands commands);

/// Adds the shapes of one body to `shapes`. `parts`: of a mesh, or nullptr; the joints of a mesh
/// without pose or skin are at rest.
void add_touching_shapes(
    const WaterTouch& touch, const Affine& world, const TouchParts* parts, const SkinData* skin,
    const Pose* pose, std::vector<TouchingShape>& shapes);

/// What `shape` pushes up in water whose surface, without ripples, is `surface`, `level` [m]
/// higher. Nothing where its middle is not over a field of this extent.
[[nodiscard]] WaterBulge
bulge_of(const TouchingShape& shape, const WaterSurface& surface, float level, const Vec2& extent);

}  // namespace limn
