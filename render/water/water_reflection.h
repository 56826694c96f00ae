#pragma once

#include "ecs/entity.h"
#include "render/render_view.h"

#include <optional>

namespace limn {

// Planar reflections (WaterReflection::Planar, water.reflection-refraction-maps): the scene above
// the water is rendered once more from a camera mirrored at the rest surface, clipped there. Only
// one body has it: of those that request it and are visible from above, the nearest. The others
// fall back to screen-space reflections. The mirrored scene has no water and no caustics.

struct PlanarWater {
    Entity entity;
    float level = 0;      ///< of the surface at rest [m]
    float map_scale = 1;  ///< resolution relative to the main view, per side
};

[[nodiscard]] std::optional<PlanarWater>
find_planar_water(const World& world, const RenderView& view);

/// The view mirrored at the plane y = `level`. Mirroring alone would make the camera left-handed;
/// flipping it vertically restores that, and triangle winding is unchanged: point (u, v) of the
/// image is at (u, 1 - v).
[[nodiscard]] RenderView make_reflected_view(const RenderView& view, float level, float map_scale);

}  // namespace limn
