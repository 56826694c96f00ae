#include "ecs/components/all.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "tests/near.h"
#include "tests/render/particle_fixture.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace limn::test::particle_light_test {
namespace {

// Light on particles, evaluated at their corners or once for each.

struct LitScene : Scene {
    LitScene() { world.insert_resource(FrameTime{}); }

    /// White, halfway through their life of a second.
    Entity emit(const std::vector<Vec3>& positions, const ParticleLook& look) {
        ParticlePool pool = pool_at(positions, {1, 0.5f, 0.25f});
        for (std::uint32_t i = 0; i < pool.look.size(); ++i) {
            pool.look[i] = i * 7919;
        }
        return world.create(ParticleEmitter{}, look, pool);
    }
    Vec3 center_pixel() { return rgb_at(radiance(look({0, 0, 1}, {0, 0, 0}, 9, 9)), 4, 4); }
    void light_at(ParticleLitAt where) {
        world.query<const ParticleLook>().each([&](Entity entity, const ParticleLook&) {
            world.get<ParticleLook>(entity).lit_at = where;
        });
    }
    /// Of all pixels.
    Vec3 sum() {
        const gpu::FloatImage image = radiance(look({0, 0, 4}, {0, 0, 0}, 64, 64));
        Vec3 all(0);
        for (int i = 0; i < 64 * 64; ++i) {
            all += rgb_at(image, i % 64, i / 64);
        }
        return all;
    }
};

ParticleLook lit_disc(float size, float forward) {
    ParticleLook look;
    look.size = size;
    look.lit_at = ParticleLitAt::Middle;
    look.forward = forward;
    look.softness = 0;
    return look;
}

/// Radiance of a white disc that faces the camera, as the mean of its four corners: their normals
/// lean outward by 0.8. `cosine`: between the directions to the light and to the camera.
double mean_of_corners(double cosine, double forward) {
    constexpr double kRoundness = 0.8;
    const double across = std::sqrt(1 - cosine * cosine);
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
        const double angle =
            0.3 + 0.5 * static_cast<double>(kPi) * i;  // whichever: the mean does not depend on it
        const double wrapped = 0.5
                               + 0.5 * (cosine + kRoundness * std::cos(angle) * across)
                                     / std::sqrt(1 + kRoundness * kRoundness);
        sum += wrapped * wrapped / 4;
    }
    const double g2 = forward * forward;
    const double lobe = (1 - g2) / (4 * std::pow(1 + g2 + 2 * forward * cosine, 1.5));
    return (sum + std::abs(forward) * (lobe - sum)) / static_cast<double>(kPi);
}

/// Mean of 1 / d^2 over a ball around the origin, to a position at `away`.
double mean_over_ball(double radius, double away) {
    constexpr int kSteps = 400;
    double sum = 0;
    double volume = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double r = radius * (i + 0.5) / kSteps;
        for (int j = 0; j < kSteps; ++j) {
            const double cosine = -1 + 2 * (j + 0.5) / kSteps;
            sum += r * r / (r * r + away * away - 2 * r * away * cosine);
            volume += r * r;
        }
    }
    return sum / volume;
}

}  // namespace

TEST_CASE_FIXTURE(
    LitScene, "particle light: at the center it is the mean of the corners"
                  * technique("particle.lit-in-middle")) {
    const Entity one = emit({{0, 0, 0}}, lit_disc(1, 0));
    for (const float forward : {0.0f, 0.6f, -0.4f}) {
        world.get<ParticleLook>(one).forward = forward;
        for (const Vec3 to_light :
             {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0.6f, 0, 0.8f),
              Vec3(0.48f, 0.64f, -0.6f)}) {
            world.query<const DirectionalLight>().each([&](Entity entity, const DirectionalLight&) {
                world.get<DirectionalLight>(entity).illuminance = 0;
            });
            shine(DirectionalLight{.illuminance = 2}, look_at(Vec3(0), -to_light));
            CAPTURE(forward);
            CAPTURE(to_light.z);
            CHECK(
                static_cast<double>(center_pixel().x)
                == near(2 * mean_of_corners(to_light.z, forward)).epsilon(2e-3));
        }
    }
}

TEST_CASE_FIXTURE(
    LitScene, "particle light: at the center and at the corners, small ones give the same light"
                  * technique("particle.lit-in-middle")) {
    world.insert_resource(Environment{.intensity = 0.2f});
    shine(DirectionalLight{.illuminance = 0.3f}, look_at(Vec3(0), {1, -2, -1}));
    shine(PointLight{.color = {1, 0.5f, 0.2f}, .intensity = 20}, at({2, 3, 1}));
    shine(PointLight{.color = {0.2f, 0.5f, 1}, .intensity = 30}, at({-3, 0, -2}));
    std::vector<Vec3> positions;
    for (int i = 0; i < 200; ++i) {
        const float turn = 2.4f * static_cast<float>(i);
        const float away = 0.1f * std::sqrt(static_cast<float>(i));
        positions.emplace_back(away * std::cos(turn), away * std::sin(turn), 0.3f * std::sin(turn));
    }
    ParticleLook look = lit_disc(0.12f, 0.5f);
    look.cover = 0;
    emit(positions, look);
    look.facing = ParticleFacing::Velocity;
    emit(positions, look);
    const Vec3 in_middle = sum();
    light_at(ParticleLitAt::Corners);
    const Vec3 at_corners = sum();
    CHECK(at_corners.x > 1);
    for (int i = 0; i < 3; ++i) {
        CHECK(in_middle[i] == near(at_corners[i]).epsilon(0.01));
    }
}

TEST_CASE_FIXTURE(
    LitScene, "particle light: a lamp within a puff lights it as the mean of its ball"
                  * technique("particle.lit-in-middle")) {
    const float radius = 0.5f;
    emit({{0, 0, 0}}, lit_disc(2 * radius, 0));
    const Entity lamp = shine(PointLight{.intensity = 1.5f, .radius = 0}, at({0, 0, 1}));
    for (const ParticleLitAt where : {ParticleLitAt::Middle, ParticleLitAt::Corners}) {
        light_at(where);
        for (const float fraction : {0.02f, 0.3f, 0.7f, 0.95f, 1.1f, 1.5f, 3.0f}) {
            CAPTURE(fraction);
            world.get<WorldTransform>(lamp).world = at({0, 0, fraction * radius});
            const auto away = static_cast<double>(fraction * radius);
            const double irradiance = 1.5 * mean_over_ball(static_cast<double>(radius), away);
            CHECK(
                static_cast<double>(center_pixel().x)
                == near(irradiance * mean_of_corners(1, 0)).epsilon(0.05));
        }
    }
}

TEST_CASE_FIXTURE(
    LitScene, "particle light: each is lit where its look says, all in one image"
                  * technique("particle.lit-in-middle")) {
    // From the camera: the corners of each are lit alike. The center of a quad is on the diagonal
    // of its two triangles, where light is the mean of two corners, not of four.
    shine(PointLight{.intensity = 2, .radius = 0}, at({0, 0, 1}));
    ParticleLook look = lit_disc(0.2f, 0);
    constexpr float kAside = 32.0f / 65;  // the center of a pixel
    const std::vector<Vec3> left = {{-kAside, kAside, 0}, {-kAside, -kAside, 0}};
    emit(left, look);
    look.lit_at = ParticleLitAt::Corners;
    emit({{kAside, -kAside, 0}}, look);
    look.lit = 0;
    look.emission = 0.1f;
    emit({{kAside, kAside, 0}}, look);
    const gpu::FloatImage image = radiance(this->look({0, 0, 1}, {0, 0, 0}, 65, 65));
    const float lit = image.at(16, 48, 0);
    CHECK(lit > 0.1f);
    CHECK(image.at(16, 16, 0) == near(lit).epsilon(1e-3));
    CHECK(std::max(image.at(48, 16, 0), image.at(48, 48, 0)) == near(lit).epsilon(1e-3));
    CHECK(std::min(image.at(48, 16, 0), image.at(48, 48, 0)) == near(0.1f).epsilon(1e-3));
}

}  // namespace limn::test::particle_light_test
