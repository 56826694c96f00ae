#pragma once

#include "content/bake/furrow_height.h"
#include "ecs/base/result.h"
#include "ecs/components/furrows.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

struct MeshData;

// From a mesh and an author's furrow settings to maps, in one call.

/// A preset by its index in furrow_presets(), after None.
enum class FurrowPresetName : std::uint8_t { None };

struct FurrowRecipe {
    FurrowPresetName preset = FurrowPresetName::None;
    FurrowProjection projection = FurrowProjection::Uv;
    int size = 512;
    bool tiles = false;
    std::vector<FurrowArrow> arrows = {};
    FurrowStyle style = {};
};

LIMN_FIELDS(FurrowRecipe) {
    LIMN_FIELD(
        preset, .doc = "settings of a figure of Bando 2001, instead of scale, noise and bump",
        .values = "none hand foot arm hand_close_up faint distinct smooth rough brdf_1 "
                  "brdf_2 light_skin dark_skin",
        .renamed = "measured_1=brdf_1 measured_2=brdf_2");
    LIMN_FIELD(projection, .doc = "how the surface is flattened", .values = "uv planar cylinder");
    LIMN_FIELD(size, "width of the image", "px", 1, 4096);
    LIMN_FIELD(tiles, "uv: the image repeats in both directions");
    LIMN_FIELD(arrows, "the fields at some points; if empty, one points upwards, the other across");
    visit_fields(self.style, visit);
}

/// The style of the recipe, with its preset.
[[nodiscard]] FurrowStyle style_of(const FurrowRecipe& recipe);

/// The flattened mesh of the recipe, with its fields. Fails as make_furrow_map does.
[[nodiscard]] Result<FurrowMap> lay_out_furrows(const MeshData& mesh, const FurrowRecipe& recipe);

struct FurrowMaps {
    FurrowGrowth growth;
    std::vector<float> height;  ///< with noise
    std::vector<Vec3> normals;  ///< unit
};

[[nodiscard]] FurrowMaps make_furrow_maps(const FurrowMap& map, const FurrowStyle& style);

/// Extends height and normals by `rings` pixels beyond the surface, each with the mean of its
/// neighbors in the previous ring, so that filtering at the borders of a texture atlas stays within
/// skin.
void add_furrow_gutter(FurrowMaps& maps, int rings);

}  // namespace limn
