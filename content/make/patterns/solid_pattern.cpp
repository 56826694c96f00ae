#include "content/make/patterns/solid_pattern.h"

#include "content/bake/relief_bake.h"
#include "content/bake/tile_surface.h"
#include "content/make/models/shapes.h"
#include "content/make/models/teapot.h"
#include "content/make/patterns/pattern_tools.h"

#include <cstdint>
#include <vector>

namespace limn {
namespace {

static_assert(static_cast<int>(SolidSide::Back) == static_cast<int>(BoxFace::Back));

MeshData solid_mesh(SolidShape shape) {
    switch (shape) {
    case SolidShape::Torus:
        return make_torus({});
    case SolidShape::Ball:
        return make_sphere({});
    case SolidShape::Teapot:
        break;
    }
    return make_teapot({.divisions = 12});
}

}  // namespace

ImageData make_solid_relief(const MeshData& mesh, SolidSide side, int size) {
    // The tile is stretched to a square with an empty border. Normals are those of the mesh still.
    TileSurface tile = tile_of(mesh, static_cast<BoxFace>(side), 0, false);
    const float border = 1 / static_cast<float>(size);
    for (Vec3& p : tile.positions) {
        p.x = glm::mix(border, 1 - border, p.x);
        p.y = glm::mix(border, 1 - border, p.y / tile.size.y);
    }
    tile.size.y = 1;
    BakedMap map = bake_relief(tile, TileCaster(tile), ReliefLayout::Double, size, 1).map;
    for (Vec4& texel : map.texels) {
        texel.z = texel.w >= 1 ? 0.0f : texel.z;
    }
    return {.name = {}, .width = size, .height = size, .pixels = map_bytes(map, 4)};
}

PatternMaps make_solid(const SolidPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    PatternMaps maps = make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const float grain = fbm(uv, 48, seed + 10, 4, 0.7f);
        PatternTexel t;
        t.color = pattern.color * (1.0f + 0.25f * fbm(uv, 6, seed + 20) + 0.15f * grain);
        t.roughness = pattern.roughness + 0.1f * grain;
        return t;
    });
    maps.relief = make_solid_relief(solid_mesh(pattern.shape), pattern.side, pattern.image.size);
    return maps;
}

}  // namespace limn
