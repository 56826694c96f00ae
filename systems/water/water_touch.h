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

// Shapes of bodies in water, and the water that each displaces.
//
// Submersion is measured against the surface of ocean and waves, raised by the displacement of all
// bodies: so a boat that rides a swell emits no rings, and a pool rises according to its current
// level. Ripples are excluded to avoid feedback: a body's own bulge would submerge it and grow.
// Waves shorter than the body are excluded as well, since they average out.
//
// A mesh (TouchShape::Mesh) is approximated by one ellipsoid per joint, fitted to the bounds of the
// vertices that the joint influences most, and moved by the pose. Their total displacement is
// scaled to the volume of the mesh; if it is open or inside out, the volume of the ellipsoids is
// used.

/// A shape in world space; `half` and `offset` are in the local space given by `world`.
struct TouchingShape {
    WallShape shape = WallShape::Ball;
    Vec3 half = {0, 0, 0};
    Vec3 offset = {0, 0, 0};
    Affine world;
    float fill = 1;  ///< fraction of its volume that displaces water
};

/// Ellipsoids of a mesh, one per joint of its skin or, without one, for its bounds.
[[nodiscard]] TouchParts make_touch_parts(const MeshData& mesh, const SkinData* skin);

/// Adds TouchParts to bodies of shape Mesh, and replaces them when mesh or skin changes. Before
/// update_water_ripples, with a sync point in between.
void add_touch_parts(
    Query<const WaterTouch, const MeshInstance, Optional<const Deformed>, Optional<TouchParts>>
        bodies,
    Res<const Assets> assets, Commands commands);

/// Appends the shapes of one body to `shapes`. `parts` are those of a mesh, or nullptr; without
/// pose or skin, joints are at rest.
void add_touching_shapes(
    const WaterTouch& touch, const Affine& world, const TouchParts* parts, const SkinData* skin,
    const Pose* pose, std::vector<TouchingShape>& shapes);

/// Displacement of `shape` in water whose surface, without ripples, is `surface` raised by `level`
/// [m]. Empty if its center is not over a field of this extent.
[[nodiscard]] WaterBulge
bulge_of(const TouchingShape& shape, const WaterSurface& surface, float level, const Vec2& extent);

}  // namespace limn
