#pragma once

#include "content/bake/furrow_recipe.h"
#include "content/make/patterns/pattern_maps.h"

#include <cstdint>

namespace limn {

// Skin with wrinkle furrows as a procedural material: a sample surface goes through the same steps
// as a mesh in `limn bake furrows`.

/// The surface on which furrows grow.
enum class FurrowSurface : std::uint8_t {
    Square,  ///< flat, faces +z, from -0.5 to 0.5 m; with uv its image tiles
    Pad,     ///< the same with a round elevation
    Limb,    ///< a tube around y, 1 m high and around; its image is for u around, v along
    Hand,    ///< a body part of 1 m, whose texture coordinates its image is for (body_part.h)
    Foot,
};

struct FurrowsPattern {
    FurrowRecipe recipe = {.tiles = true};
    FurrowSurface surface = FurrowSurface::Square;
    bool smooth_normals = true;
    int cells = 0;
    float cell_depth = 0.15f;
    Vec3 color = {0.52f, 0.30f, 0.22f};
    float roughness = 0.48f;
};

LIMN_FIELDS(FurrowsPattern) {
    visit_fields(self.recipe, visit);
    LIMN_FIELD(surface, .doc = "surface on which they grow", .values = "square pad limb hand foot");
    LIMN_FIELD(smooth_normals, "normals include the curvature of the flattened surface");
    LIMN_FIELD(cells, "finest relief: isotropic cells along each side; 0: none", "", 0, 256);
    LIMN_FIELD(cell_depth, "depth of the edges between cells", "", 0, 1);
    LIMN_FIELD(color, .doc = "color of the skin", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(roughness, "perceptual roughness", "", 0, 1);
}

/// The mesh of a surface, with normals and uvs.
[[nodiscard]] MeshData make_furrow_surface(FurrowSurface surface);

/// Skin without furrows if the surface cannot be flattened by the projection.
[[nodiscard]] PatternMaps make_furrows(const FurrowsPattern& pattern);

}  // namespace limn
