#include "bench/oracles/particle_shadow_oracle.h"
#include "ecs/components/all.h"
#include "ecs/components/particles.h"
#include "ecs/components/shadow.h"
#include "ecs/components/time.h"
#include "render/graph/frame_graph.h"
#include "render/particles/particle_shadow_pass.h"
#include "tests/near.h"
#include "tests/render/particle_fixture.h"
#include "tests/render/scene_fixture.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>

namespace limn::test::particle_shadow_test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// A white wall in z = 0, of half side 2, before it a camera that does not see particles.
struct ShadowScene : Scene {
    MeshId square = add(make_square());
    MaterialId white = add(Material{.base_color = {1, 1, 1, 1}, .roughness = 1});
    Entity wall = world.create();

    ShadowScene() {
        world.insert_resource(FrameTime{});
        put_wall(0);
    }
    void put_wall(float z) {
        world.destroy(wall);
        wall = place(square, white, affine_from({0, 0, z}, {1, 0, 0, 0}, Vec3(2)));
    }
    Entity add_sun() {
        return shine(DirectionalLight{.illuminance = 3}, at({0, 0, 5}));  // along -z
    }
    /// Particles at rest, halfway through their life.
    Entity emit(const std::vector<Vec3>& positions, const ParticleLook& look) {
        return world.create(ParticleEmitter{}, look, pool_at(positions));
    }
    gpu::FloatImage wall_image(float z = 0) { return radiance(look({0, 0, z + 2}, {0, 0, z})); }
    /// At the center of the wall; a pixel is 1/16 m.
    Vec3 center_pixel(float z = 0) { return rgb_at(wall_image(z), 32, 32); }
};

/// Of this opacity at the center; it casts a shadow, and is invisible to a camera nearby.
ParticleLook caster(float size, float opacity) {
    ParticleLook look;
    look.size = size;
    look.colors = {{.at = 0, .opacity = opacity}};
    look.near_fade = 1000;
    look.shadow = 1;
    return look;
}

/// A cloud of 60 discs in x, y = -0.9 .. 0.9 and z = 0.6 .. 3.4, by the Weyl sequence.
std::vector<Vec3> cloud() {
    std::vector<Vec3> positions;
    for (int i = 1; i <= 60; ++i) {
        const auto fraction = [&](double step) { return std::fmod(step * i, 1.0); };
        positions.emplace_back(
            1.8 * fraction(0.8191725134) - 0.9, 1.8 * fraction(0.6710436067) - 0.9,
            0.6 + 2.8 * fraction(0.5497004779));
    }
    return positions;
}

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest,
    "particle shadow: behind all slabs the series is exact" * technique("particle.shadow")) {
    std::vector<Vec4> inputs;
    for (const float depth : {0.2f, 0.5f, 0.83f}) {
        for (const float thickness : {0.0f, 0.1f, 0.3f}) {
            inputs.emplace_back(0.7f, depth, thickness, 0);
        }
    }
    const std::vector<Vec4> found = evaluate_shader(
        "#include \"lib/fourier_opacity.glsl\"\n",
        "OpacitySeries s = slab_series(x.x, x.y, x.z);\n"
        "y = vec4(optical_depth(s, 1.0), optical_depth(s, 7.0), optical_depth(s, 0.0), 0.0);",
        inputs);
    for (const Vec4& moments : found) {
        CHECK(moments.x == near(-std::log(0.3)).epsilon(1e-4));
        CHECK(moments.y == near(-std::log(0.3)).epsilon(1e-4));
        CHECK(moments.z == near(0).epsilon(1e-4));
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "particle shadow: the series of a slab is that of its density, term by term"
                    * technique("particle.shadow")) {
    // By sums over the depth in double precision.
    const double depth = 0.4;
    const double thickness = 0.2;
    const std::vector<Vec4> found = evaluate_shader(
        "#include \"lib/fourier_opacity.glsl\"\n",
        "OpacitySeries s = slab_series(0.5, 0.4, 0.2); y = x.x == 0.0 ? s.low : s.high;",
        {Vec4(0), Vec4(1)});
    const auto term = [&](int k, bool sine) {
        constexpr int kSteps = 20000;
        double sum = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double at = depth + thickness * ((i + 0.5) / kSteps - 0.5);
            const double angle = 2 * 3.14159265358979 * k * at;
            sum += (sine ? std::sin(angle) : std::cos(angle)) / kSteps;
        }
        return 2 * std::log(2.0) * sum;
    };
    const double wanted[] = {term(0, false), term(1, false), term(1, true), term(2, false),
                             term(2, true),  term(3, false), term(3, true)};
    for (int i = 0; i < 7; ++i) {
        CAPTURE(i);
        const float moment = i < 4 ? found[0][i] : found[1][i - 4];
        CHECK(moment == near(wanted[i]).epsilon(1e-4));
    }
}

TEST_CASE("particle shadow: the map of a sun covers all casters, in depth too") {
    const Vec3 axis = glm::normalize(Vec3(0.4f, -0.8f, 0.2f));
    const std::vector<ShadowBall> balls = {{{1, 2, 3}, 0.5f}, {{-2, 0, 1}, 1}, {{0, 5, 0}, 0.1f}};
    const ParticleShadowView view = view_from_sun(4, axis, balls);
    CHECK(view.record[4].x == 4);
    CHECK(std::abs(glm::dot(view.right, axis)) < 1e-6f);
    CHECK(std::abs(glm::dot(view.up, axis)) < 1e-6f);
    for (const ShadowBall& ball : balls) {
        for (const Vec3& direction : {view.right, view.up, axis}) {
            for (const float side : {-1.0f, 1.0f}) {
                const Vec4 position = Vec4(ball.center + side * ball.radius * direction, 1);
                for (int row = 0; row < 3; ++row) {
                    const float at = glm::dot(view.record[static_cast<std::size_t>(row)], position);
                    CHECK(at > -1e-4f);
                    CHECK(at < 1 + 1e-4f);
                }
            }
        }
    }
    const Vec4 deeper = Vec4(0.25f * axis, 0);
    CHECK(glm::dot(view.record[2], deeper) == near(0.25f * view.record[4].y));
    CHECK(view_from_sun(4, axis, {}).record[4].x == -1);
}

TEST_CASE_FIXTURE(
    ShadowScene, "particle shadow: a surface behind a puff gets the light that it leaves"
                     * technique("particle.shadow")) {
    add_sun();
    const float open = center_pixel().x;
    const float edge = wall_image().at(4, 4, 0);
    ParticleLook look = caster(1, 0.5f);
    const Entity puff = emit({{0.03125f, -0.03125f, 0.8f}}, look);
    CHECK(center_pixel().x / open == near(0.5).epsilon(0.01));
    CHECK(wall_image().at(4, 4, 0) / edge == near(1).epsilon(1e-3));  // beside it
    // Two that lie one behind the other leave the product.
    const Entity other = emit({{0.03125f, -0.03125f, 1.6f}}, look);
    CHECK(center_pixel().x / open == near(0.25).epsilon(0.01));
    world.destroy(other);
    // A factor on the opacity, and one on the optical depth of each color.
    look.shadow = 0.4f;
    world.add(puff, ParticleLook(look));
    CHECK(center_pixel().x / open == near(0.8).epsilon(0.01));
    look.shadow = 1;
    look.shadow_tint = {0, 0.5f, 1};
    world.add(puff, ParticleLook(look));
    const Vec3 tinted = center_pixel() / open;
    CHECK(tinted.x == near(1).epsilon(0.01));
    CHECK(tinted.y == near(std::sqrt(0.5)).epsilon(0.01));
    CHECK(tinted.z == near(0.5).epsilon(0.01));
    // What only adds light hides none.
    look.cover = 0;
    world.add(puff, ParticleLook(look));
    CHECK(center_pixel().z / open == near(1).epsilon(1e-3));
}

TEST_CASE_FIXTURE(
    ShadowScene, "particle shadow: within a cloud it is the sum over all particles, to 0.03"
                     * technique("particle.shadow")) {
    const std::vector<Vec3> positions = cloud();
    std::vector<oracle::ShadowDisc> discs;
    for (const Vec3& position : positions) {
        discs.push_back({.center = position, .diameter = 0.8, .opacity = 0.3});
    }
    add_sun();
    for (const auto& placed :
         {std::pair(0.0f, 0.002), std::pair(1.4f, 0.03), std::pair(2.0f, 0.03)}) {
        const float z = placed.first;
        const double limit = placed.second;
        CAPTURE(z);
        put_wall(z);
        world.query<const ParticlePool>().each([&](Entity emitter, const ParticlePool&) {
            world.find<ParticleLook>(emitter)->shadow = 0;
        });
        const gpu::FloatImage open = wall_image(z);
        if (world.query<const ParticlePool>().empty()) {
            emit(positions, caster(0.8f, 0.3f));
        }
        world.query<ParticleLook>().each([](ParticleLook& caster) { caster.shadow = 1; });
        const gpu::FloatImage found = wall_image(z);
        double sum = 0;
        double darkest = 1;
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                const glm::dvec3 position = {
                    (x + 0.5) / 16 - 2, 2 - (y + 0.5) / 16, static_cast<double>(z)};
                const double exact = oracle::disc_transmittance(discs, position, {0, 0, -1});
                const double transmitted =
                    static_cast<double>(found.at(x, y, 0) / open.at(x, y, 0));
                sum += (transmitted - exact) * (transmitted - exact);
                darkest = std::min(darkest, exact);
            }
        }
        CHECK(darkest < 0.5);
        CHECK(std::sqrt(sum / (64 * 64)) <= limit);
    }
}

TEST_CASE_FIXTURE(
    ShadowScene, "particle shadow: a particle is dimmed by those before it alone"
                     * technique("particle.shadow")) {
    world.destroy(wall);
    add_sun();
    ParticleLook visible = caster(0.5f, 0.9f);
    visible.near_fade = 0;
    visible.shadow = 0;
    visible.softness = 0;
    emit({{0, 0, 0}}, visible);
    const float open = center_pixel().x;
    // The puff between it and the sun is out of the camera's sight, the one behind it is not.
    const Entity before = emit({{0, 0, 4}}, caster(6, 0.6f));
    CHECK(center_pixel().x / open == near(0.4).epsilon(0.02));
    world.destroy(before);
    emit({{0, 0, -4}}, caster(6, 0.6f));
    CHECK(center_pixel().x / open == near(1).epsilon(0.02));
}

TEST_CASE_FIXTURE(
    ShadowScene, "particle shadow: without a sun they are in the light of a spot"
                     * technique("particle.shadow")) {
    world.create(
        SpotLight{.intensity = 40, .radius = 20, .inner_angle = 0.5f, .outer_angle = 0.6f},
        Shadow{}, WorldTransform{at({0, 0, 4})});
    const float open = center_pixel().x;
    REQUIRE(open > 0);
    emit({{0.02f, 0.02f, 2}}, caster(1, 0.5f));
    CHECK(center_pixel().x / open == near(0.5).epsilon(0.02));
    // The disc appears at twice its size: at 0.75 m from the center, r = 0.75 of its radius.
    const gpu::FloatImage image = wall_image();
    world.query<ParticleLook>().each([](ParticleLook& look) { look.shadow = 0; });
    const gpu::FloatImage bare = wall_image();
    const double at = (44.5 / 16 - 2 - 0.04) / 1.0;
    const double inside = 1 - at * at;
    CHECK(
        image.at(44, 32, 0) / bare.at(44, 32, 0) == near(1 - 0.5 * inside * inside).epsilon(0.03));
}

TEST_CASE_FIXTURE(
    ShadowScene, "particle shadow: without casters there is neither a pass nor a shadow") {
    add_sun();
    const gpu::FloatImage open = wall_image();
    ParticleLook look = caster(1, 0.5f);
    look.shadow = 0;
    emit({{0, 0, 0.8f}}, look);
    CHECK(largest_difference(wall_image(), open) <= 1e-4f);
    CHECK_FALSE(frame_graph(shared_renderer()).was_run("particle shadows"));
    world.query<ParticleLook>().each([](ParticleLook& caster) { caster.shadow = 1; });
    CHECK(largest_difference(wall_image(), open) > 0.05f);
    CHECK(frame_graph(shared_renderer()).was_run("particle shadows"));
}

TEST_CASE_FIXTURE(
    ShadowScene, "particle shadow: particles that are not finite cast none, and break nothing") {
    add_sun();
    const float open = center_pixel().x;
    const float huge = std::numeric_limits<float>::max();
    ParticleLook look = caster(1, 1);
    emit({{kNaN, 0, 1}, {huge, huge, huge}, {0, -INFINITY, 1}}, look);
    look.shadow = kNaN;
    emit({{0, 0, 1}}, look);
    look.shadow = -3;
    emit({{0, 0, 1}}, look);
    CHECK(center_pixel().x == near(static_cast<double>(open)).epsilon(1e-3));
    look.shadow = 9;  // as 1
    look.shadow_tint = {kNaN, -2, 7};
    emit({{0, 0, 1}}, look);
    const Vec3 found = center_pixel() / open;
    CHECK(found.x == near(1).epsilon(0.01));
    CHECK(found.y == near(1).epsilon(0.01));
    CHECK(found.z == near(0.02).epsilon(0.05));
}

}  // namespace limn::test::particle_shadow_test
