#pragma once

#include "content/bake/furrow_recipe.h"
#include "content/make/patterns/pattern_maps.h"

#include <cstdint>

namespace limn {

// Skin with wrinkle furrows, as a procedural material: a sample of a surface goes through all that
// a mesh does in `limn bake furrows`.

/// What furrows grow on.
enum class FurrowSurface : std::uint8_t {
    Square,  ///< flat, faces +z, from -0.5 to 0.5 m; by uv its image tiles
    Pad,     ///< the same with a round elevation
    Limb,    ///< a tube around y, 1 m high and around; its image is for u around, v along
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
    LIMN_FIELD(surface, .doc = "what they grow on", .values = "square pad limb");
    LIMN_FIELD(smooth_normals, "normals have the curvature of the surface laid flat");
    LIMN_FIELD(
        cells, "finest relief: cells along each side, without direction; 0: none", "", 0, 256);
    LIMN_FIELD(cell_depth, "of the edges between them", "", 0, 1);
    LIMN_FIELD(color, .doc = "of the skin", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(roughness, "perceptual roughness", "", 0, 1);
}

/// The mesh of a surface, with normals and uvs.
[[nodiscard]] MeshData make_furrow_surface(FurrowSurface surface);

/// Where the surface cannot be laid flat that way, skin without furrows.
[[nodiscard]] PatternMaps make_furrows(const FurrowsPattern& pattern);

}  // namespace limn
