#pragma once

#include "ecs/entity.h"
#include "render/render_view.h"

#include <optional>

namespace limn {

// Planar reflections (WaterReflection::Planar, water.reflection-refraction-maps): what is above the
// water is drawn once more from a camera mirrored in the surface at rest, and cut off there. One
// body has it in a picture: of those that ask for it, seen from above, the nearest. The others make
// do with what the picture shows. The mirrored scene has no water in it and no caustics.

struct PlanarWater {
    Entity entity;
    float level = 0;      ///< of the surface at rest [m]
    float map_scale = 1;  ///< side of the reflection's picture over that of the whole
};

[[nodiscard]] std::optional<PlanarWater>
find_planar_water(const World& world, const RenderView& view);

/// The same pixels, seen from the other side of the plane y = `level`. A mirrored camera is
/// left-handed; turned upside down it is a camera again, and no triangle changes its winding: point
/// (u, v) of the picture is at (u, 1 - v).
[[nodiscard]] RenderView make_reflected_view(const RenderView& view, float level, float map_scale);

}  // namespace limn
