#include "content/load/faces/face_wrinkles.h"
#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/wrinkle.h"
#include "ecs/world.h"

#include <doctest/doctest.h>

#include <utility>

namespace limn::face_wrinkles_test {
namespace {

/// A world with one face of one triangle.
struct Face {
    Face() {
        MeshData skin;
        skin.positions.resize(3);
        skin.normals.resize(3);
        skin.tangents.resize(3);
        skin.uvs1.resize(3);
        skin.morphs.resize(1);
        skin.regions.resize(1);
        Assets assets;
        assets.meshes.push_back(skin);
        assets.materials.emplace_back();
        world.insert_resource(std::move(assets));
        face = world.create(Deformed{}, MeshInstance{.mesh = {0}, .material = {0}});
    }
    [[nodiscard]] Assets& assets() { return world.resource<Assets>(); }

    World world;
    Entity face;
};

}  // namespace

TEST_CASE("face wrinkles: an imported face gets folds, and keeps the material of others") {
    Face scene;
    const Entity ear = scene.world.create(MeshInstance{.mesh = {0}, .material = {0}});
    CHECK(add_face_wrinkles(scene.world) == 1);
    CHECK(scene.world.has<WrinkleSurface>(scene.face));
    CHECK_FALSE(scene.world.has<WrinkleSurface>(ear));
    REQUIRE(scene.assets().images.size() == 1);
    REQUIRE(scene.assets().materials.size() == 2);
    const auto& material = scene.world.get<MeshInstance>(scene.face).material;
    CHECK(material.index == 1);
    CHECK(scene.assets().materials[1].wrinkle_texture.image.index == 0);
    CHECK(scene.assets().materials[1].wrinkle_texture.uv_set == 1);
    CHECK(scene.assets().materials[0].wrinkle_texture.image.index == kNoAsset);
    CHECK(add_face_wrinkles(scene.world) == 0);
}

TEST_CASE("face wrinkles: none where a mesh lacks what they need, or has a map of its own") {
    const auto wrinkles_without = [](auto&& change) {
        Face scene;
        change(scene.assets());
        return add_face_wrinkles(scene.world);
    };
    CHECK(wrinkles_without([](Assets& assets) { assets.meshes[0].regions.clear(); }) == 0);
    CHECK(wrinkles_without([](Assets& assets) { assets.meshes[0].morphs.clear(); }) == 0);
    CHECK(wrinkles_without([](Assets& assets) { assets.meshes[0].uvs1.clear(); }) == 0);
    CHECK(wrinkles_without([](Assets& assets) { assets.meshes[0].tangents.clear(); }) == 0);
    CHECK(
        wrinkles_without([](Assets& assets) {
            assets.images.emplace_back();
            assets.materials[0].wrinkle_texture.image = {0};
        })
        == 0);
    CHECK(wrinkles_without([](Assets&) {}) == 1);
}

}  // namespace limn::face_wrinkles_test
