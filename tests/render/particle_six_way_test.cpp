#include "ecs/components/all.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>

namespace limn::test::particle_six_way_test {
namespace {

/// Bytes of the six sides: right, above, behind; left, below, toward the camera.
constexpr std::array<std::uint8_t, 6> kSides = {200, 40, 120, 20, 240, 80};
constexpr std::array<Vec3, 6> kFrom = {Vec3(1, 0, 0), {0, 1, 0},  {0, 0, -1},
                                       {-1, 0, 0},    {0, -1, 0}, {0, 0, 1}};

ImageData plain_image(const std::array<std::uint8_t, 4>& pixel) {
    ImageData image;
    image.width = image.height = 1;
    image.srgb = false;
    image.pixels.assign(pixel.begin(), pixel.end());
    return image;
}

struct SixWayScene : Scene {
    SixWayScene() {
        world.insert_resource(FrameTime{});
        look_.image = add(plain_image({kSides[0], kSides[1], kSides[2], 255}));
        look_.negative_light = add(plain_image({kSides[3], kSides[4], kSides[5], 51}));
        look_.size = 1;
        look_.softness = 0;
        look_.turn_spread = 0;
        look_.colors = {{.at = 0, .color = {0.5f, 0.5f, 0.5f}}};
    }
    /// The center pixel of a particle at the origin, seen from +z.
    Vec3 center_pixel(const ParticleLook& look) {
        ParticlePool pool;
        for (auto* column : {&pool.x, &pool.y, &pool.z, &pool.vx, &pool.vy, &pool.vz}) {
            column->push_back(0);
        }
        pool.age.push_back(0.5f);
        pool.life.push_back(1);
        pool.look.push_back(7);
        const Entity entity = world.create(ParticleEmitter{}, look, pool);
        const Vec3 found = rgb_at(radiance(this->look({0, 0, 1}, {0, 0, 0}, 9, 9)), 4, 4);
        world.destroy(entity);
        return found;
    }
    Vec3 lit_from(const Vec3& side, const ParticleLook& look) {
        const Vec3 eye = glm::normalize(side);
        const Entity sun = shine(DirectionalLight{.illuminance = kPi}, look_at(eye, {0, 0, 0}));
        const Vec3 found = center_pixel(look);
        world.destroy(sun);
        return found;
    }
    ParticleLook look_;
};

float response(int side) {
    return 0.5f * static_cast<float>(kSides[static_cast<std::size_t>(side)]) / 255;
}

}  // namespace

TEST_CASE_FIXTURE(
    SixWayScene, "particle six-way: light from each side is what the image says of that side") {
    for (int side = 0; side < 6; ++side) {
        CAPTURE(side);
        const Vec3 found = lit_from(kFrom[static_cast<std::size_t>(side)], look_);
        CHECK(found.x == near(response(side)).epsilon(0.01));
        CHECK(found.z == near(response(side)).epsilon(0.01));
    }
}

TEST_CASE_FIXTURE(
    SixWayScene, "particle six-way: between sides they count by the squares of the cosines") {
    const Vec3 from = glm::normalize(Vec3(-1, 2, 0.5f));
    const float expected = from.x * from.x * response(3) + from.y * from.y * response(1)
                           + from.z * from.z * response(5);
    CHECK(lit_from(from, look_).y == near(expected).epsilon(0.01));
    // So what is as bright from all sides is as bright from between them.
    look_.image = add(plain_image({128, 128, 128, 255}));
    look_.negative_light = add(plain_image({128, 128, 128, 0}));
    CHECK(lit_from(from, look_).y == near(0.5 * 128 / 255).epsilon(0.01));
}

TEST_CASE_FIXTURE(SixWayScene, "particle six-way: its sides turn with the particle") {
    look_.spin = kPi;  // a quarter, at the age of half a second
    // Its right is the world's above.
    CHECK(lit_from({0, 1, 0}, look_).x == near(response(0)).epsilon(0.01));
    CHECK(lit_from({-1, 0, 0}, look_).x == near(response(1)).epsilon(0.01));
    CHECK(lit_from({0, 0, 1}, look_).x == near(response(5)).epsilon(0.01));
}

TEST_CASE_FIXTURE(
    SixWayScene, "particle six-way: it glows by the opacity of the second image, lit or not") {
    look_.emission = 3;
    CHECK(center_pixel(look_).x == near(0.5 * 3 * 51 / 255).epsilon(0.01));
    look_.lit = 0;
    CHECK(lit_from({1, 0, 0}, look_).x == near(0.5 * 3 * 51 / 255).epsilon(0.01));
}

TEST_CASE_FIXTURE(
    SixWayScene, "particle six-way: an even environment is what all sides send back together") {
    world.insert_resource(
        Environment{.sky = SkyKind::Uniform, .zenith = {2, 2, 2}, .visible = false});
    float sum = 0;
    for (int side = 0; side < 6; ++side) {
        sum += response(side);
    }
    // Over all directions the square of a cosine on one side is 2 pi / 3 of the radiance; a white
    // surface sends back 1 / pi of its irradiance.
    CHECK(center_pixel(look_).x == near(2 * sum * 2 / 3).epsilon(0.02));
}

TEST_CASE_FIXTURE(SixWayScene, "particle six-way: others beside it are drawn as without it") {
    ParticleLook plain = look_;
    plain.negative_light = {};
    const Vec3 alone = lit_from({0, 1, 1}, plain);
    const Entity far_one = world.create(ParticleEmitter{}, look_, [] {
        ParticlePool pool;
        pool.x.push_back(50);
        for (auto* column : {&pool.y, &pool.z, &pool.vx, &pool.vy, &pool.vz}) {
            column->push_back(0);
        }
        pool.age.push_back(0.5f);
        pool.life.push_back(1);
        pool.look.push_back(7);
        return pool;
    }());
    const Vec3 beside = lit_from({0, 1, 1}, plain);
    world.destroy(far_one);
    CHECK(alone.x > 0.05f);
    CHECK(glm::distance(alone, beside) < 1e-5f);
}

}  // namespace limn::test::particle_six_way_test
