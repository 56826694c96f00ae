#include "render/lens/dazzle_pass.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <vector>

namespace limn::test::dazzle_test {
namespace {

const Dazzle kLamp = {
    .color = {0.2f, 0.6f, 4}, .opacity = 0.8f, .angle = 0.5f, .source_size = 0.02f};

/// A uniform sky, viewed from the origin along -z.
struct DazzleScene : Scene {
    DazzleScene() {
        world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = Vec3(1)});
    }
    RenderView view = look({0, 0, 0}, {0, 0, -1}, 64, 64);

    Entity shine_at(const Vec3& position) {
        return world.create(kLamp, WorldTransform{at(position)});
    }
    void clear_points() {
        std::vector<Entity> all;
        world.query<const Dazzle>().each(
            [&](Entity entity, const Dazzle&) { all.push_back(entity); });
        for (const Entity entity : all) {
            world.destroy(entity);
        }
    }
    Vec3 corner() { return rgb_at(radiance(view), 3, 3); }
    /// Share of the color that the image has taken on, by its blue.
    float weight() { return (corner().z - 1) / (kLamp.color.z - 1); }
};

}  // namespace

TEST_CASE(
    "dazzle: full opacity straight ahead, half at half the angle, none beyond it"
    * technique("engine.obfuscating-point")) {
    CHECK(dazzle_weight(kLamp, 0) == near(0.8));
    CHECK(dazzle_weight(kLamp, 0.25f) == near(0.4));
    CHECK(dazzle_weight(kLamp, 0.5f) == 0);
    CHECK(dazzle_weight(kLamp, 3) == 0);
    CHECK(dazzle_weight(kLamp, std::numeric_limits<float>::quiet_NaN()) == 0);
    CHECK(dazzle_weight({.angle = 0}, 0) == 0);
}

TEST_CASE_FIXTURE(
    DazzleScene, "dazzle: the image is mixed with the color by the weight"
                     * technique("engine.obfuscating-point")) {
    shine_at({0, 0, -5});
    const Vec3 mixed = corner();
    for (int c = 0; c < 3; ++c) {
        CHECK(mixed[c] == near(0.2 + 0.8 * kLamp.color[c]).epsilon(2e-3));
    }
    clear_points();
    shine_at({5 * std::tan(0.25f), 0, -5});
    CHECK(weight() == near(0.4).epsilon(5e-3));
    clear_points();
    shine_at({0, 0, 5});  // behind
    CHECK(weight() == 0);
    clear_points();
    shine_at({0, 0, 0});  // at the eye
    CHECK(weight() == near(0.8).epsilon(2e-3));
}

TEST_CASE_FIXTURE(
    DazzleScene, "dazzle: a surface in front of the point hides it, one behind it does not"
                     * technique("engine.obfuscating-point")) {
    shine_at({0, 0, -5});
    const MeshId square = add(make_square());
    const MaterialId black =
        add(Material{.shading = ShadingModel::Unlit, .base_color = {0, 0, 0, 1}});
    const Entity wall = place(square, black, at({0, 0, -6}));
    CHECK(weight() == near(0.8).epsilon(2e-3));
    world.destroy(wall);
    const Entity hidden = place(square, black, at({0, 0, -3}));
    CHECK(weight() == 0);
    world.destroy(hidden);
    place(square, black, at({-1, 0, -3}));  // its edge is at the image center
    CHECK(weight() == near(0.4).epsilon(0.2));
}

TEST_CASE_FIXTURE(
    DazzleScene, "dazzle: a directional light dazzles from its direction"
                     * technique("engine.obfuscating-point")) {
    const Affine pose = affine_from({0, 0, 0}, glm::angleAxis(kPi, Vec3(0, 1, 0)), Vec3(1));
    const Entity sun =
        world.create(kLamp, DirectionalLight{.enabled = false}, WorldTransform{pose});
    CHECK(weight() == near(0.8).epsilon(2e-3));
    world.get<WorldTransform>(sun).world = at({0, 0, 0});
    CHECK(weight() == 0);
}

TEST_CASE_FIXTURE(
    DazzleScene, "dazzle: without it, or with invalid values, there is no pass and no NaN") {
    const float plain = corner().x;
    CHECK_FALSE(frame_graph(shared_renderer()).was_run("dazzle"));
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    world.create(
        Dazzle{.color = {kNan, 0, 0}, .opacity = kNan, .angle = kNan, .source_size = kNan},
        WorldTransform{at({0, 0, -5})});
    world.create(kLamp, WorldTransform{at({kNan, 0, -5})});
    CHECK(corner().x == plain);
}

}  // namespace limn::test::dazzle_test
