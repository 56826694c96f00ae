#include "content/bake/furrow_recipe.h"

#include "content/bake/furrow_field.h"
#include "content/bake/furrow_map.h"
#include "content/bake/furrow_presets.h"
#include "ecs/base/check.h"
#include "ecs/components/surface.h"

#include <algorithm>
#include <cstddef>
#include <vector>

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

void add_furrow_gutter(FurrowMaps& maps, int rings) {
    const IVec2 size = maps.growth.size;
    std::vector<int> ring(maps.height.size());  // 0 within the surface
    for (std::size_t i = 0; i < ring.size(); ++i) {
        ring[i] = maps.growth.cover[i] < 0 ? rings + 1 : 0;
    }
    for (int now = 1; now <= rings; ++now) {
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                const auto pixel = static_cast<std::size_t>(y * size.x + x);
                if (ring[pixel] <= rings) {
                    continue;
                }
                float height = 0;
                Vec3 normal(0);
                float count = 0;
                for (int j = std::max(y - 1, 0); j <= std::min(y + 1, size.y - 1); ++j) {
                    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, size.x - 1); ++i) {
                        const auto near = static_cast<std::size_t>(j * size.x + i);
                        if (ring[near] < now) {
                            height += maps.height[near];
                            normal += maps.normals[near];
                            count += 1;
                        }
                    }
                }
                if (count > 0) {
                    ring[pixel] = now;
                    maps.height[pixel] = height / count;
                    maps.normals[pixel] = normalize_or(normal, {0, 0, 1});
                }
            }
        }
    }
}

}  // namespace limn
