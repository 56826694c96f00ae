#include "ecs/components/height_field.h"
#include "ecs/components/height_image.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"
#include "systems/particles/height_image_system.h"
#include "systems/particles/particle_obstacles.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

namespace limn::height_image_test {
namespace {

/// Red rises by 1 from the center of the first column of texels to that of the last.
ImageData make_ramp(PixelFormat format) {
    constexpr int kSize = 16;
    ImageData image;
    image.width = kSize;
    image.height = kSize;
    image.format = format;
    const std::size_t bytes = format == PixelFormat::Rgba8 ? 1 : 4;
    image.pixels.resize(kSize * kSize * 4 * bytes);
    for (std::size_t texel = 0; texel < kSize * kSize; ++texel) {
        const float red = static_cast<float>(texel % kSize) / (kSize - 1);
        if (format == PixelFormat::Rgba8) {
            image.pixels[4 * texel] = static_cast<std::uint8_t>(std::lround(255 * red));
        } else {
            std::memcpy(&image.pixels[16 * texel], &red, sizeof(red));
        }
    }
    return image;
}

constexpr HeightImage kSlope = {
    .image = {}, .size = {16, 16}, .points = 33, .height = 15, .base = 2};

}  // namespace

TEST_CASE(
    "height image: a ramp of one meter per meter has that height and the normal of its slope"
    * technique("particle.heightfield-collision")) {
    for (const PixelFormat format : {PixelFormat::Rgba8, PixelFormat::Rgba32F}) {
        HeightField field;
        fill_height_image(kSlope, make_ramp(format), field);
        REQUIRE(field.points == 33);
        for (std::size_t j = 0; j < 33; ++j) {
            for (std::size_t i = 2; i < 31; ++i) {  // within the centers of the outer texels
                const double x = 0.5 * static_cast<double>(i) - 0.5;
                CHECK(field.height[33 * j + i] == test::near(2 + x).epsilon(1e-5));
                CHECK(
                    glm::distance(field.normal[33 * j + i], Vec3(-0.70710678f, 0.70710678f, 0))
                    < (i > 2 && i < 30 ? 1e-3f : 0.2f));
            }
        }
        CHECK(field.low == test::near(2));
        CHECK(field.range == test::near(15));
    }
}

TEST_CASE("height image: without pixels it is flat, at its base") {
    HeightField field;
    ImageData broken = make_ramp(PixelFormat::Rgba8);
    broken.pixels.resize(7);
    for (const ImageData& image : {ImageData{}, broken}) {
        fill_height_image(kSlope, image, field);
        CHECK(field.height == std::vector<float>(33 * 33, 2.0f));
        CHECK(sample_red(image, {0.5f, 0.5f}) == 0);
    }
    ImageData bad = make_ramp(PixelFormat::Rgba32F);
    const float nan = NAN;
    std::memcpy(&bad.pixels[0], &nan, sizeof(nan));
    CHECK(sample_red(bad, {0, 0}) == 0);
    CHECK(sample_red(bad, {NAN, 0}) == 0);
}

TEST_CASE("height image: it is a collider, and filled again when its image changes") {
    World world;
    Assets assets;
    assets.images.push_back(make_ramp(PixelFormat::Rgba32F));
    world.insert_resource(std::move(assets));
    HeightImage settings = kSlope;
    settings.image = {0};
    const Entity entity = world.create(settings);
    world.run(add_height_images);
    world.run(update_height_images);
    const auto height_below = [&](float x) {
        const std::optional<Collider> shape = find_solid_shape(
            {.shape = ColliderShape::HeightField}, Affine{}, world.find<HeightField>(entity));
        REQUIRE(shape.has_value());
        return push_out(*shape, {x, -5, 0.3f}).y;
    };
    CHECK(height_below(0) == test::near(9.5).epsilon(1e-5));
    CHECK(height_below(3) == test::near(12.5).epsilon(1e-5));
    ImageData& image = world.resource<Assets>().images[0];
    std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{0});
    world.run(update_height_images);
    CHECK(height_below(3) == test::near(12.5).epsilon(1e-5));  // its version is the same
    ++image.version;
    world.run(update_height_images);
    CHECK(height_below(3) == test::near(2).epsilon(1e-5));
    world.get<HeightImage>(entity).base = 7;
    world.run(update_height_images);
    CHECK(height_below(3) == test::near(7).epsilon(1e-5));
}

}  // namespace limn::height_image_test
