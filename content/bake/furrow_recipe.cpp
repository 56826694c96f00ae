#include "content/bake/furrow_recipe.h"

#include "content/bake/furrow_field.h"
#include "content/bake/furrow_map.h"
#include "content/bake/furrow_presets.h"
#include "ecs/base/check.h"
#include "ecs/components/surface.h"

#include <cstddef>

namespace limn {

FurrowStyle style_of(const FurrowRecipe& recipe) {
    const auto preset = static_cast<std::size_t>(recipe.preset);
    LIMN_CHECK(preset <= furrow_presets().size());
    return preset == 0 ? recipe.style : with_preset(recipe.style, furrow_presets()[preset - 1]);
}

Result<FurrowMap> lay_out_furrows(const MeshData& mesh, const FurrowRecipe& recipe) {
    const auto edits = place_furrow_arrows(recipe.arrows, mesh.positions, mesh.normals);
    const auto field = make_furrow_field(mesh.positions, mesh.normals, edits);
    return make_furrow_map(
        mesh, field, {.projection = recipe.projection, .size = recipe.size, .tiles = recipe.tiles});
}

FurrowMaps make_furrow_maps(const FurrowMap& map, const FurrowStyle& style) {
    FurrowMaps maps;
    maps.growth = grow_furrows(map, style);
    maps.height = add_furrow_noise(maps.growth, style);
    maps.normals = make_furrow_normals(map, maps.growth, maps.height, style.bump);
    return maps;
}

}  // namespace limn
