#include "ecs/components/billboard.h"
#include "ecs/components/time.h"
#include "render/geometry/culling.h"
#include "render/particles/billboard_list.h"
#include "render/particles/particle_culling.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>
#include <glm/packing.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace limn::test::billboard_drawing_test {
namespace {

const std::string kCode = "#include \"lib/billboard.glsl\"\n";

/// right of billboard_right() for an axis along z or y, seen from each of `to_camera`.
std::vector<Vec3> rights(const std::string& axis, const std::vector<Vec3>& to_camera) {
    std::vector<Vec4> inputs;
    for (const Vec3& v : to_camera) {
        inputs.emplace_back(v, 0);
    }
    std::vector<Vec3> answers;
    for (const Vec4& y : evaluate_shader(
             kCode, "y.xyz = billboard_right(" + axis + ", x.xyz, vec3(1.0, 0.0, 0.0));", inputs)) {
        answers.emplace_back(y);
    }
    return answers;
}

ParticleLook unlit(const Vec3& color) {
    ParticleLook look;
    look.size = 1;
    look.colors = {{.at = 0, .color = color}};
    look.emission = 1;
    look.lit = 0;
    look.softness = 0;
    return look;
}

struct BillboardScene : Scene {
    BillboardScene() { world.insert_resource(FrameTime{}); }

    Entity stand(const Billboard& billboard, const ParticleLook& look, const Affine& pose) {
        return world.create(billboard, look, WorldTransform{pose}, PreviousWorldTransform{pose});
    }
    ImageId white() {
        ImageData image;
        image.width = image.height = 1;
        image.pixels = {255, 255, 255, 255};
        return add(image);
    }
    /// Lit pixels of an image of 64 x 64, seen from `eye` toward the origin.
    int lit_pixels(const Vec3& eye) {
        const gpu::FloatImage image = radiance(look(eye, {0, 0, 0}));
        int lit = 0;
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                lit += rgb_at(image, x, y).x > 0.5f ? 1 : 0;
            }
        }
        return lit;
    }
};

}  // namespace

TEST_CASE(
    "billboard: about y it turns by the signed angle, its normal toward the viewpoint"
    * technique("engine.billboard")) {
    // V, from the viewpoint to the billboard, and the angle from +z [degrees].
    const std::vector<Vec4> table = {{0, 0, -1, 0}, {1, 0, 0, -90}, {-1, 0, 0, 90}, {0, 0, 1, 180}};
    std::vector<Vec3> to_camera;
    for (const Vec4& row : table) {
        to_camera.push_back(-Vec3(row));
    }
    const std::vector<Vec3> right = rights("vec3(0.0, 1.0, 0.0)", to_camera);
    for (std::size_t i = 0; i < table.size(); ++i) {
        const Vec3 normal = glm::cross(right[i], Vec3(0, 1, 0));
        const double angle = std::atan2(normal.x, normal.z) * 180 / std::numbers::pi;
        CHECK(std::cos((angle - table[i].w) * std::numbers::pi / 180) == near(1).epsilon(1e-6));
    }
    to_camera.clear();
    for (int i = 0; i < 64; ++i) {
        const float angle = 0.1f * static_cast<float>(i);
        to_camera.emplace_back(3 * std::sin(angle), 0, 3 * std::cos(angle));
    }
    const std::vector<Vec3> around = rights("vec3(0.0, 1.0, 0.0)", to_camera);
    for (std::size_t i = 0; i < around.size(); ++i) {
        CHECK(
            glm::dot(glm::cross(around[i], Vec3(0, 1, 0)), to_camera[i] / 3.0f)
            == near(1).epsilon(1e-6));
    }
}

TEST_CASE(
    "billboard: above the axis it keeps the last angle of a camera that came there"
    * technique("engine.billboard")) {
    // It comes from +z, with +x to its right, until it is exactly above.
    const std::vector<Vec3> approach = rights(
        "vec3(0.0, 1.0, 0.0)", {{0, 3, 1}, {0, 3, 0.01f}, {0, 3, 1e-5f}, {0, 3, 0}, {0, 0, 0}});
    for (const Vec3& right : approach) {
        CHECK(glm::length(right - Vec3(1, 0, 0)) < 1e-5f);
    }
}

TEST_CASE(
    "composite billboard: axes of the book's example, orthonormal, and turning with the camera"
    * technique("engine.billboard-composite")) {
    // X = V x Mz, to the left of the quad: V = (1, 0, 0), Mz = (0, 0, 1) give (0, -1, 0).
    const std::string axis = "vec3(0.0, 0.0, 1.0)";
    const Vec3 x = -rights(axis, {{1, 0, 0}})[0];
    CHECK(glm::length(x - Vec3(0, -1, 0)) < 1e-6f);
    CHECK(glm::length(glm::cross(Vec3(0, 0, 1), x) - Vec3(1, 0, 0)) < 1e-6f);

    std::vector<Vec3> to_camera;
    for (int i = 0; i < 60; ++i) {
        const float angle = 0.1f * static_cast<float>(i);
        to_camera.emplace_back(
            2 * std::cos(angle), 2 * std::sin(angle), 0.07f * static_cast<float>(i - 30));
    }
    const std::vector<Vec3> around = rights(axis, to_camera);
    for (std::size_t i = 0; i < around.size(); ++i) {
        const Vec3 left = -around[i];
        const Vec3 normal = glm::cross(Vec3(0, 0, 1), left);  // Y
        CHECK(glm::length(left) == near(1));
        CHECK(std::abs(left.z) < 1e-6f);
        CHECK(std::abs(glm::dot(left, to_camera[i])) < 1e-5f);
        CHECK(glm::length(glm::cross(left, normal) - Vec3(0, 0, 1)) < 1e-5f);
        CHECK(glm::dot(normal, to_camera[i]) == near(2));  // never edge-on
        const float angle = 0.1f * static_cast<float>(i);
        CHECK(glm::length(left - Vec3(std::sin(angle), -std::cos(angle), 0)) < 1e-5f);
    }
}

TEST_CASE(
    "billboard: colors are mixed by the function, and its extents and opacity vary"
    * technique("engine.billboard")) {
    ParticleLook look = unlit({1, 0, 0});
    look.colors = {{0, {1, 0, 0}, 1}, {1, {0, 0, 1}, 1}};
    look.color_function = {.wave = Wave::Sawtooth};
    look.size = 4;
    const Billboard billboard = {
        .alignment = BillboardAlignment::None,
        .aspect = 0.5f,
        .size_function = {.wave = Wave::Sawtooth, .base = 2, .amplitude = 1},
        .opacity_function = {.wave = Wave::Triangle, .base = 0.5f, .amplitude = 0.5f}};
    BillboardList list;
    append_billboard(billboard, look, at({1, 2, 3}), 0.25, 0, list);
    REQUIRE(list.quads.size() == 1);
    CHECK(list.shadings[0].color_at == near(0.25));
    const Vec4 color = sample_colors(look.colors, list.shadings[0].color_at);
    CHECK(color.x == near(0.75));
    CHECK(color.z == near(0.25));
    CHECK(list.shadings[0].opacity == near(1));
    CHECK(list.quads[0].up.y == near(2 * 1.5));
    CHECK(list.quads[0].right.x == near(1.5));
    CHECK(list.shadings[0].position == Vec3(1, 2, 3));
    list = {};
    append_billboard(billboard, look, at({1, 2, 3}), 0.75, 0, list);
    CHECK(list.shadings[0].opacity == near(0).scale(1));
}

TEST_CASE("billboard: NaN, and no extent, draw nothing") {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    BillboardList list;
    for (const float bad : {kNan, 0.0f, -1.0f}) {
        ParticleLook look = unlit({1, 1, 1});
        look.size = bad;
        append_billboard({}, look, at({0, 0, 0}), 0, 0, list);
    }
    append_billboard({}, unlit({1, 1, 1}), at({kNan, 0, 0}), 0, 0, list);
    CHECK(list.quads.empty());
}

TEST_CASE_FIXTURE(
    BillboardScene, "billboard: parallel to the image it is as large from any view"
                        * technique("engine.billboard")) {
    ParticleLook look = unlit({1, 1, 1});
    look.image = white();
    stand({}, look, at({0, 0, 0}));
    const int front = lit_pixels({0, 0, 2});
    CHECK(front == 256);  // a quarter of the height, squared
    for (const Vec3& eye : {Vec3(2, 0, 0), Vec3(0, 0, -2), Vec3(1.2f, 1.6f, 0)}) {
        CHECK(std::abs(lit_pixels(eye) - front) <= 64);
    }
    // And off the center, where one that faces the eye would appear larger: the same square.
    world.query<WorldTransform>().each(
        [](WorldTransform& transform) { transform.world.row[0].w = 0.8f; });
    world.query<PreviousWorldTransform>().each(
        [](PreviousWorldTransform& transform) { transform.world.row[0].w = 0.8f; });
    CHECK(std::abs(lit_pixels({0, 0, 2}) - front) <= 64);
}

TEST_CASE_FIXTURE(
    BillboardScene,
    "billboard: one that stands as it is vanishes edge-on, a tree does not and keeps its axis"
        * technique("engine.billboard")) {
    ParticleLook look = unlit({1, 1, 1});
    look.image = white();
    const Entity entity =
        stand({.alignment = BillboardAlignment::None, .aspect = 0.5f}, look, at({0, 0, 0}));
    const int front = lit_pixels({0, 0, 2});
    CHECK(front == 128);
    CHECK(lit_pixels({2, 0, 0.001f}) < 40);
    world.get<Billboard>(entity).alignment = BillboardAlignment::Axis;
    CHECK(std::abs(lit_pixels({0, 0, 2}) - front) <= 32);
    CHECK(std::abs(lit_pixels({2, 0, 0}) - front) <= 32);
    CHECK(lit_pixels({0.01f, 2, 0.01f}) < 0.2 * front);  // from above it does not lean back
}

TEST_CASE_FIXTURE(
    BillboardScene, "composite billboard: end-on one quad shows, from the side the other"
                        * technique("engine.billboard-composite")) {
    ParticleLook look = unlit({1, 1, 1});
    look.image = white();
    Billboard shot = {.alignment = BillboardAlignment::Composite, .aspect = 0.25f};
    shot.section = look.image;
    stand(shot, look, at({0, 0, 0}));
    const int side = lit_pixels({2, 0, 0});
    CHECK(side == near(0.25 * 256).epsilon(0.4));
    CHECK(std::abs(lit_pixels({0, 0, 2}) - side) <= 32);
    const int along = lit_pixels({0.001f, 2, 0.001f});
    CHECK(along > 0.15 * side);
    CHECK(along < 0.5 * side);
}

TEST_CASE_FIXTURE(
    BillboardScene, "billboard: frames of its flipbook, and covered from back to front"
                        * technique("engine.billboard")) {
    // Two frames side by side: red, green.
    ImageData frames;
    frames.width = 16;
    frames.height = 8;
    for (int i = 0; i < 16 * 8; ++i) {
        const bool first = i % 16 < 8;
        for (const int value : {first ? 255 : 0, first ? 0 : 255, 0, 255}) {
            frames.pixels.push_back(static_cast<std::uint8_t>(value));
        }
    }
    ParticleLook look = unlit({1, 1, 1});
    look.image = add(frames);
    look.columns = 2;
    look.frame_rate = 10;
    const Entity entity = stand({.time = 0.05}, look, at({0, 0, 0}));
    const auto center_pixel = [&] {
        return rgb_at(radiance(this->look({0, 0, 2}, {0, 0, 0})), 32, 32);
    };
    CHECK(center_pixel().x > 0.9f);
    world.get<Billboard>(entity).time = 0.15 + 1.0 / 60;
    CHECK(center_pixel().y > 0.9f);
    CHECK(center_pixel().x < 0.1f);
    ParticleLook blue = unlit({0, 0, 1});
    blue.image = white();
    stand({}, blue, at({0, 0, 0.5f}));
    CHECK(center_pixel().z > 0.9f);
    CHECK(center_pixel().y < 0.1f);
    ParticleLook added = unlit({0.5f, 0, 0});
    added.image = blue.image;
    added.cover = 0;
    stand({}, added, at({0, 0, 0.7f}));
    CHECK(center_pixel().z > 0.9f);
    CHECK(center_pixel().x == near(0.5).epsilon(0.01));
}

TEST_CASE(
    "particle visibility: those in view are those of a brute-force test"
    * technique("particle.visibility")) {
    std::vector<ParticleInstance> instances(2000);
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const auto n = static_cast<float>(i);
        instances[i].position = {
            40 * std::fmod(n * 0.754878f, 1.0f) - 20, 40 * std::fmod(n * 0.569840f, 1.0f) - 20,
            40 * std::fmod(n * 0.618034f, 1.0f) - 20};
    }
    const RenderView view = Scene().look({0, 0, 5}, {0, 0, 0});
    const Frustum frustum = make_frustum(view.clip_from_world);
    LookExtent extent;
    extent.radius = 0.5f;
    std::vector<std::uint8_t> visible;
    cull_particles(instances, {extent}, frustum, visible);
    int shown = 0;
    for (std::size_t i = 0; i < instances.size(); ++i) {
        bool inside = true;
        for (const Vec4& plane : frustum.planes) {
            const double length = glm::length(Vec3(plane));
            inside =
                inside && (glm::dot(Vec3(plane), instances[i].position) + plane.w) / length > -0.5;
        }
        CHECK(visible[i] == (inside ? 1 : 0));
        shown += visible[i];
    }
    CHECK(shown > 100);
    CHECK(shown < 1900);
}

TEST_CASE(
    "particle visibility: a streak whose center is out of view is drawn if it extends into it") {
    const Frustum frustum = make_frustum(Scene().look({0, 0, 5}, {0, 0, 0}).clip_from_world);
    const auto shown = [&](float x, float stretch, float speed) {
        ParticleInstance instance;
        instance.position = {x, 0, 0};
        instance.velocity_xy = glm::packHalf2x16(Vec2(speed, 0));
        LookExtent extent;
        extent.radius = 0.1f;
        extent.stretch = stretch;
        std::vector<std::uint8_t> visible;
        cull_particles({instance}, {extent}, frustum, visible);
        return visible[0] == 1;
    };
    CHECK(shown(0, 0.5f, 0));
    CHECK(shown(50, 0.5f, 128));  // 64 m
    CHECK_FALSE(shown(50, 0.5f, 32));
    CHECK_FALSE(shown(50, 0, 128));
}

TEST_CASE(
    "particle visibility: an emitter hides all with it, bounds only if none is in view"
    * technique("particle.visibility")) {
    std::vector<ParticleInstance> instances(2);
    instances[0].position = {0, 0, 0};  // in view
    instances[1].position = {50, 0, 0};
    const Frustum frustum = make_frustum(Scene().look({0, 0, 5}, {0, 0, 0}).clip_from_world);
    const auto shown = [&](LookExtent extent) {
        extent.radius = 0.1f;
        std::vector<std::uint8_t> visible;
        cull_particles(instances, {extent}, frustum, visible);
        return visible[0] + visible[1];
    };
    CHECK(shown({.culling = ParticleCulling::Particles}) == 1);
    CHECK(shown({.culling = ParticleCulling::Bounds, .group = {{0, 0, 0}, {50, 0, 0}}}) == 2);
    CHECK(shown({.culling = ParticleCulling::Emitter, .group = {{49, -1, -1}, {51, 1, 1}}}) == 0);
    CHECK(shown({.culling = ParticleCulling::Emitter, .group = {{-1, -1, -1}, {1, 1, 1}}}) == 2);
}

TEST_CASE_FIXTURE(
    BillboardScene,
    "particle visibility: an emitter out of view hides what flew into it, unless bounds count"
        * technique("particle.visibility")) {
    ParticleLook look = unlit({1, 1, 1});
    ParticlePool pool;
    for (auto* const column : {&pool.x, &pool.y, &pool.z, &pool.vx, &pool.vy, &pool.vz}) {
        column->push_back(0);
    }
    pool.age.push_back(0.5f);
    pool.life.push_back(1);
    pool.look.push_back(7);
    const Entity entity = world.create(
        ParticleEmitter{}, look, pool, WorldTransform{at({50, 0, 0})},
        PreviousWorldTransform{at({50, 0, 0})});
    const auto center_pixel = [&] {
        return rgb_at(radiance(this->look({0, 0, 2}, {0, 0, 0})), 32, 32).x;
    };
    CHECK(center_pixel() > 0.9f);
    world.get<ParticleLook>(entity).culling = ParticleCulling::Bounds;
    CHECK(center_pixel() > 0.9f);
    world.get<ParticleLook>(entity).culling = ParticleCulling::Emitter;
    CHECK(center_pixel() == 0);
    world.get<ParticleLook>(entity).cull_margin = 60;
    CHECK(center_pixel() > 0.9f);
}

}  // namespace limn::test::billboard_drawing_test
