#include "ecs/components/all.h"
#include "ecs/components/height_fog.h"
#include "ecs/components/time.h"
#include "tests/near.h"
#include "tests/render/particle_fixture.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <span>

namespace limn::test::height_fog_test {
namespace {

constexpr Vec3 kEmission = {3, 2, 1};

struct FogScene : Scene {
    FogScene() { world.insert_resource(FrameTime{}); }

    /// The center pixel of a square that covers the view from `eye` toward `target`.
    Vec3 through_pane(const Vec3& eye, const Vec3& target, float opacity = 1) {
        const Vec3 z = glm::normalize(eye - target);
        const Vec3 x = glm::normalize(glm::cross(Vec3(0, 0, 1) + 0.1f * Vec3(0, 1, 0), z));
        const Vec3 y = glm::cross(z, x);
        const float size = 5;
        Affine world_from_square = affine_from(target, {1, 0, 0, 0}, Vec3(1));
        for (int i = 0; i < 3; ++i) {
            world_from_square.row[i] = Vec4(size * x[i], size * y[i], size * z[i], target[i]);
        }
        const Entity square = place(
            add(make_square()),
            add(Material{
                .shading = ShadingModel::Unlit,
                .alpha_mode = opacity < 1 ? AlphaMode::Blend : AlphaMode::Opaque,
                .double_sided = true,
                .base_color = Vec4(kEmission / 3.0f, opacity)}),
            world_from_square);
        const Vec3 through = center_color(eye, target);
        world.destroy(square);
        return through;
    }
    /// Discs of 2 m that give off `color`.
    void add_particles(std::span<const Vec3> positions, const Vec3& color) {
        ParticleLook look;
        look.size = 2;
        look.colors = {{.at = 0, .color = color, .opacity = 1}};
        look.emission = 1;
        look.lit = 0;
        look.softness = 0;
        world.create(ParticleEmitter{}, look, pool_at(positions));
    }
    Vec3 center_color(const Vec3& eye, const Vec3& target) {
        return rgb_at(radiance(look(eye, target, 33, 33)), 16, 16);
    }
};

/// Light through the fog and what the fog adds, by many short steps in double precision.
struct March {
    double passed = 1;
    double added = 0;  ///< of a source of 1
};
March march(const HeightFog& fog, const Vec3& from, const Vec3& to) {
    constexpr int kSteps = 200000;
    const double length = glm::length(glm::dvec3(to) - glm::dvec3(from));
    March sum;
    for (int i = 0; i < kSteps; ++i) {
        const double y = from.y + (double{to.y} - from.y) * (i + 0.5) / kSteps;
        const double taken =
            fog.density * std::exp(-(y - fog.base) / fog.scale_height) * length / kSteps;
        sum.added += sum.passed * taken;
        sum.passed *= 1 - taken;
    }
    return sum;
}

const std::array kRays = {
    std::array{Vec3(0, 1, 0), Vec3(0, 1, -8)},     // level
    std::array{Vec3(0, 0, 0), Vec3(20, 40, -30)},  // up, through all of it
    std::array{Vec3(2, 30, 1), Vec3(0, -2, -40)},  // down
    std::array{Vec3(0, 1, 0), Vec3(0, 1.001f, -60)}};

}  // namespace

TEST_CASE_FIXTURE(
    FogScene, "height fog: the closed form matches a ray march" * technique("light.height-fog")) {
    const HeightFog fog = {
        .density = 0.05f, .base = 1, .scale_height = 7, .ambient = {0.2f, 0.4f, 0.8f}, .sun = 0};
    for (const auto& [eye, target] : kRays) {
        CAPTURE(target);
        world.remove_resource<HeightFog>();
        const Vec3 clear = through_pane(eye, target);
        const Vec3 clear_pane = through_pane(eye, target, 0.5f);
        world.insert_resource(HeightFog{fog});
        const March truth = march(fog, eye, target);
        const Vec3 through = through_pane(eye, target);
        const Vec3 pane = through_pane(eye, target, 0.5f);
        const Vec3 behind = center_color(eye, target);  // the fog up to the sky
        for (int i = 0; i < 3; ++i) {
            CHECK(clear[i] > 0.3f);
            CHECK(
                through[i]
                == test::near(clear[i] * truth.passed + fog.ambient[i] * truth.added)
                       .epsilon(1e-3));
            // Half of the pane lies in front of what is behind it.
            CHECK(
                pane[i]
                == test::near(
                       clear_pane[i] * truth.passed + 0.5 * fog.ambient[i] * truth.added
                       + 0.5 * behind[i])
                       .epsilon(2e-3));
        }
    }
}

TEST_CASE_FIXTURE(FogScene, "height fog: the sky is dimmed by the fog above the camera") {
    world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = {2, 2, 2}});
    world.insert_resource(
        HeightFog{.density = 0.02f, .base = 0, .scale_height = 25, .ambient = {1, 1, 1}, .sun = 0});
    const double up = std::exp(-0.02 * 25 * std::exp(-5.0 / 25));
    CHECK(center_color({0, 5, 0}, {0, 6, 0.001f}).x == test::near(2 * up + (1 - up)).epsilon(1e-3));
    CHECK(
        center_color({0, 5, 0}, {0, 5, -1}).x
        == test::near(1).epsilon(1e-3));  // the horizon is invisible
}

TEST_CASE_FIXTURE(
    FogScene, "height fog: in a furnace of its own radiance everything vanishes"
                  * technique("light.height-fog")) {
    world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = {1, 1, 1}});
    add_particles(std::array{Vec3(0.3f, 1, -4), Vec3(-0.5f, 1.4f, -9)}, Vec3(1));
    place(
        add(make_square()),
        add(Material{.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}}),
        affine_from({0, 1, -6}, {1, 0, 0, 0}, Vec3(1)));
    for (const float density : {0.01f, 0.3f}) {
        world.insert_resource(HeightFog{
            .density = density, .base = 0, .scale_height = 5, .ambient = {1, 1, 1}, .sun = 0});
        const gpu::FloatImage image = radiance(look({0, 1, 0}, {0, 1, -1}));
        for (std::size_t i = 0; i < image.pixels.size(); i += image.channels) {
            REQUIRE(image.pixels[i] == test::near(1).epsilon(2e-3));
        }
    }
}

TEST_CASE_FIXTURE(
    FogScene,
    "height fog: a particle is covered by the fog in front of it" * technique("light.height-fog")) {
    const HeightFog fog = {
        .density = 0.1f, .base = 0, .scale_height = 6, .ambient = {0.5f, 0.5f, 0.5f}, .sun = 0};
    const Vec3 eye = {0, 1, 0};
    const Vec3 there = {0, 3, -7};
    add_particles(std::array{there}, Vec3(2));
    const float clear = center_color(eye, there).x;
    CHECK(clear > 1);
    world.insert_resource(HeightFog{fog});
    const March truth = march(fog, eye, there);
    CHECK(
        center_color(eye, there).x
        == test::near(clear * truth.passed + 0.5 * truth.added).epsilon(5e-3));
}

TEST_CASE_FIXTURE(
    FogScene, "height fog: glass adds the fog in front of it to its reflection only"
                  * technique("light.height-fog")) {
    const HeightFog fog = {
        .density = 0.06f, .base = 0, .scale_height = 1e5f, .ambient = {0.5f, 0.5f, 0.5f}, .sun = 0};
    const Vec3 eye = {0, 0, 0};
    const Vec3 there = {0, 0, -20};
    const Vec3 pane = {0, 0, -8};
    const Vec3 clear = through_pane(eye, there);
    world.insert_resource(HeightFog{fog});
    const Vec3 foggy = through_pane(eye, there);
    const Entity glass = place(
        add(make_square()),
        add(Material{
            .alpha_mode = AlphaMode::Blend,
            .base_color = {1, 1, 1, 1},
            .roughness = 0,
            .transmission = 1}),
        at(pane));
    const Vec3 both = through_pane(eye, there);
    world.remove_resource<HeightFog>();
    const double passed = through_pane(eye, there).x / clear.x;  // nothing is mirrored but the dark
    world.destroy(glass);
    CHECK(passed > 0.85);
    CHECK(passed < 0.99);
    const March truth = march(fog, eye, pane);
    for (int i = 0; i < 3; ++i) {
        CHECK(
            both[i]
            == test::near(passed * foggy[i] + (1 - passed) * fog.ambient[i] * truth.added)
                   .epsilon(2e-3));
    }
}

TEST_CASE_FIXTURE(FogScene, "height fog: it scatters sunlight by the phase function") {
    world.create(
        DirectionalLight{},
        WorldTransform{
            look_at(Vec3(0, 0, 0), Vec3(0, 0, 1))});  // shines along +z: the sun is at -z
    const float g = 0.5f;
    world.insert_resource(HeightFog{
        .density = 1,
        .base = 0,
        .scale_height = 1e5f,
        .ambient = {0, 0, 0},
        .sun = 1,
        .forward = g});
    const auto phase = [&](double cosine) {
        return (1 - g * g) / (4 * 3.14159265358979 * std::pow(1 + g * g - 2 * g * cosine, 1.5));
    };
    CHECK(center_color({0, 0, 0}, {0, 0, -1}).x == test::near(3 * phase(1)).epsilon(1e-3));
    CHECK(center_color({0, 0, 0}, {1, 0, 0}).x == test::near(3 * phase(0)).epsilon(1e-3));
    CHECK(center_color({0, 0, 0}, {0, 0, 1}).x == test::near(3 * phase(-1)).epsilon(1e-3));
}

}  // namespace limn::test::height_fog_test
