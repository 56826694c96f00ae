#include "ecs/world.h"
#include "systems/faces/wrinkle_ladder_system.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <utility>

namespace limn::wrinkle_ladder_test {
namespace {

using test::near;

/// A face 0.25 m high before a camera of 90 degrees, which sees 2 d over 1080 rows at distance d.
struct Face {
    World world;
    Entity face;

    explicit Face(const WrinkleLadder& ladder = {}) {
        Assets assets;
        MeshData& mesh = assets.meshes.emplace_back();
        mesh.bounds = {{-0.1f, -0.125f, -0.1f}, {0.1f, 0.125f, 0.1f}};
        world.insert_resource(std::move(assets));
        world.create(WorldTransform{}, Camera{.fov_y = radians(90.0f)});
        face = world.create(
            ladder, MeshInstance{.mesh = {0}, .material = {}}, WorldTransform{}, WrinkleRungs{});
    }
    WrinkleRungs at(float distance, float scale = 1) {
        world.get<WorldTransform>(face).world =
            affine_from({0, 0, -distance}, Quat(1, 0, 0, 0), Vec3(scale));
        world.run(climb_wrinkle_ladders);
        return std::as_const(world).get<WrinkleRungs>(face);
    }
};

/// Distance at which the face is so many pixels high.
float distance_of(float height) {
    return 0.25f * 1080 / (2 * height);
}

}  // namespace

TEST_CASE(
    "wrinkle ladder: close by there is everything, far away nothing" * technique("skin.pipeline")) {
    Face face;
    const WrinkleRungs close = face.at(distance_of(700));
    CHECK(close.displaced == 1);
    CHECK(close.strain == 1);
    CHECK(close.maps == 1);
    const WrinkleRungs middle = face.at(distance_of(400));
    CHECK(middle.displaced == 0);
    CHECK(middle.strain == 1);
    const WrinkleRungs far = face.at(distance_of(150));
    CHECK(far.strain == 0);
    CHECK(far.maps == 1);
    CHECK(face.at(distance_of(60)).maps == 0);
    CHECK(face.at(distance_of(60), 4).maps == 1);  // a giant
}

TEST_CASE(
    "wrinkle ladder: rungs fade in over a band, so that none pops" * technique("skin.pipeline")) {
    const WrinkleLadder ladder = {.maps_from = 100, .band = 0.2f};
    CHECK(wrinkle_rungs(ladder, 100).maps == 0);
    CHECK(wrinkle_rungs(ladder, 105).maps == near(0.25));
    CHECK(wrinkle_rungs(ladder, 120).maps == near(1));
    float last = 0;
    for (float height = 10; height < 1000; height *= 1.01f) {
        const WrinkleRungs rungs = wrinkle_rungs(ladder, height);
        CHECK(rungs.maps >= last);
        CHECK(rungs.maps - last < 0.06f);
        CHECK(rungs.displaced <= rungs.strain);
        CHECK(rungs.strain <= rungs.maps);
        last = rungs.maps;
    }
    CHECK(last == 1);
}

TEST_CASE(
    "wrinkle ladder: a face without a mesh shows none, and no camera hides none"
    * technique("skin.pipeline")) {
    Face face;
    face.world.get<MeshInstance>(face.face).mesh = {};
    CHECK(face.at(0.3f).maps == 0);
    World world;
    world.insert_resource(Assets{});
    const Entity alone = world.create(WrinkleLadder{});
    world.run(add_wrinkle_rungs);
    CHECK(world.get<WrinkleRungs>(alone).maps == 1);
}

}  // namespace limn::wrinkle_ladder_test
