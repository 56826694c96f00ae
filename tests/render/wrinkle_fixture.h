#pragma once

// clang-format off: gcc 12 crashes on component_id<WorldTransform> when the fixture is not the first include
#include "tests/render/skin_fixture.h"
// clang-format on
#include "ecs/components/wrinkle.h"
#include "systems/faces/wrinkle_system.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace limn::test {

inline constexpr std::uint8_t kSlopeByte =
    128 + 60;  // of a wrinkle map: y of the normal is 60 / 127

/// Skin that a morph target shortens.
struct WrinkleScene : SkinScene {
    /// One texel: a slope along v, up the map.
    ImageId slope_map() {
        return add(ImageData{
            .name = "slope", .width = 1, .height = 1, .pixels = {128, kSlopeByte, 240, 255}});
    }
    static Vec2 map_slope() { return {0, -60.0f / 112.0f}; }

    Entity skin(MeshData mesh, const WrinkleSurface& surface, float weight) {
        mesh.regions = {
            {.name = "all",
             .weights = std::vector<float>(mesh.positions.size(), 1.0f),
             .across = std::vector<Vec3>(mesh.positions.size(), Vec3{0, 1, 0})}};
        const Entity entity = place(add(std::move(mesh)), add(material), {});
        world.add(entity, Deformed{entity, {}});
        world.add(entity, MorphWeights{.weights = {weight}, .previous = {weight}});
        world.add(entity, surface);
        world.run(prepare_wrinkles);
        return entity;
    }
    /// The square, whose height is scaled by `1 - weight`.
    Entity square(const WrinkleSurface& surface, float weight) {
        MeshData mesh = make_square();
        MorphTarget& flat = mesh.morphs.emplace_back();
        flat.name = "flat";
        for (std::uint32_t v = 0; v < 4; ++v) {
            flat.vertices.push_back(v);
            flat.positions.push_back(mesh.positions[v] * Vec3{0, -1, 0});
        }
        mesh.morphs.emplace_back().name = "age";  // moves nothing
        return skin(std::move(mesh), surface, weight);
    }

    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 32, 32);
    Material material = {
        .base_color = {0.5f, 0.4f, 0.3f, 1}, .wrinkle_texture = {.image = slope_map()}};
};

}  // namespace limn::test
