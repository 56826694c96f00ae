#include "ecs/components/time.h"
#include "ecs/components/water.h"
#include "ecs/components/water_look.h"
#include "ecs/components/water_waves.h"
#include "render/water/foam_pattern.h"
#include "systems/water/water_wave_table.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/common.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn::test::whitecaps_test {
namespace {

constexpr float kLength = 16;  // of the wave [m]
constexpr float kSteepness = 0.75f;
constexpr int kSize = 96;
constexpr float kHeight = 12;         // of the camera, which looks down on 24 m of sea [m]
constexpr float kFoam = 0.7f * 0.5f;  // thick foam under a uniform sky of 0.5

/// One trochoid wave along +x on water that mirrors 2 % and lets nothing through, from above; seen
/// along it, however it is turned.
struct Sea : Scene {
    explicit Sea(float turn = 0) : direction(turn) {
        world.insert_resource(FrameTime{});
        world.insert_resource(Environment{
            .sky = SkyKind::Uniform,
            .zenith = Vec3(0.5f),
            .horizon = Vec3(0.5f),
            .ground = Vec3(0.5f)});
        const Water water = {.absorption = Vec3(1000), .scattering = Vec3(0)};
        const WaterWaves waves = {
            .waves = {
                {.amplitude = kSteepness / number,
                 .length = kLength,
                 .direction = turn,
                 .sharpness = 1}}};
        WaveTable table;
        fill_wave_table(water, waves, 0, table);
        frequency = table.lines[0].frequency;
        sea = world.create(water, waves, table, WorldTransform{at({0, 0, 0})});
    }
    /// Columns run from -x to +x, rows from -z to +z.
    gpu::FloatImage image(const WaterLook& look) {
        world.add(sea, WaterLook{look});
        const float half = std::sqrt(0.5f);
        const Quat turned(std::cos(direction / 2), 0, -std::sin(direction / 2), 0);
        const Affine pose = affine_from({0, kHeight, 0}, turned * Quat(half, -half, 0, 0), Vec3(1));
        return radiance(make_render_view(
            {.fov_y = radians(90.0f), .near = 0.05f}, pose, pose,
            {.width = kSize, .height = kSize}));
    }
    /// Mean of each column of pixels.
    std::vector<float> columns(const WaterLook& look) {
        const gpu::FloatImage pixels = image(look);
        std::vector<float> means(kSize, 0.0f);
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                means[static_cast<std::size_t>(x)] += pixels.at(x, y, 0) / kSize;
            }
        }
        return means;
    }
    /// The column that shows the water at rest `phase` [rad] behind a crest, as the wave moves it.
    [[nodiscard]] std::size_t column_behind(float phase) const {
        const float rest = (kPi / 2 - phase) / number;  // sin(k x) = 1 at the crest
        const float x = rest + kSteepness / number * std::cos(number * rest);
        const float y = kSteepness / number * std::sin(number * rest);
        return static_cast<std::size_t>((0.5f * x / (kHeight - y) + 0.5f) * kSize);
    }

    static constexpr float number = 2 * kPi / kLength;
    float direction = 0;
    float frequency = 0;
    Entity sea;
};

float whitened(float dark, float cover) {
    const float white = (0.4f + 0.6f * cover) * cover;
    return dark + (kFoam - dark) * white;
}

/// The pattern of breaking crests at a point at rest, bilinear, 0 .. 1: a tile has a side of 53 m.
float crest_pattern(const std::vector<std::uint8_t>& texels, int side, const Vec2& rest) {
    const Vec2 at = rest / 53.0f * static_cast<float>(side) - 0.5f;
    const IVec2 first = IVec2(glm::floor(at));
    const Vec2 share = at - Vec2(first);
    float sum = 0;
    for (int i = 0; i < 4; ++i) {
        const IVec2 step = {i % 2, i / 2};
        const IVec2 texel = ((first + step) % side + side) % side;
        const Vec2 part = Vec2(step) * share + Vec2(1 - step.x, 1 - step.y) * (1.0f - share);
        sum += part.x * part.y
               * static_cast<float>(texels[static_cast<std::size_t>(texel.y * side + texel.x)]);
    }
    return sum / 255;
}

}  // namespace

TEST_CASE_FIXTURE(
    Sea, "whitecaps: a crest breaks in patches, where the pattern is high, and not all along"
             * technique("water.whitecaps")) {
    constexpr float kCrestJacobian = 1 - kSteepness;
    constexpr int kLevel = 3;
    const std::vector<std::uint8_t> texels = make_foam_pattern()[kLevel];
    constexpr float kShift = 38;  // of the sea, to where the pattern is both high and low [m]
    world.add(sea, WorldTransform{at({0, 0, -kShift})});
    const gpu::FloatImage dark = image({});
    // Cover 0 where the pattern is below 0.25, and 1 above 0.65.
    const gpu::FloatImage pixels =
        image({.foam_below = kCrestJacobian + 0.125f, .foam_decay = 0.01f});
    const auto column = static_cast<int>(column_behind(0));
    const float to_water = kHeight - kSteepness / number;
    int bare = 0;
    int covered = 0;
    for (int y = 0; y < kSize; ++y) {
        const float z = ((static_cast<float>(y) + 0.5f) / kSize * 2 - 1) * to_water;
        const float level =
            crest_pattern(texels, kFoamPatternSide >> kLevel, {0.25f * kLength, z + kShift});
        CAPTURE(z);
        CAPTURE(level);
        if (level < 0.23f) {
            CHECK(pixels.at(column, y, 0) < dark.at(column, y, 0) + 0.002f);
            ++bare;
        } else if (level > 0.67f) {
            CHECK(pixels.at(column, y, 0) == test::near(kFoam).epsilon(0.02));
            ++covered;
        }
    }
    CHECK(bare > 8);
    CHECK(covered > 8);
}

TEST_CASE_FIXTURE(
    Sea, "whitecaps: foam of crests that have passed is left to its decay"
             * technique("water.whitecaps")) {
    const std::vector<float> dark = columns({});
    constexpr float kTurn = 1.8f;  // of the wave's phase between two moments that count
    const WaterLook look = {.foam_below = 0.8f, .foam_decay = kTurn / frequency / 0.3f};
    const std::vector<float> white = columns(look);
    const std::size_t crest = column_behind(0);
    CHECK(dark[crest] < 0.03f);
    CHECK(white[crest] == test::near(kFoam).epsilon(0.01));
    for (const int moments : {1, 2}) {
        CAPTURE(moments);
        const auto i = column_behind(kTurn * static_cast<float>(moments));
        const float cover = std::exp(-0.3f * static_cast<float>(moments));
        float seen = 0;
        for (std::size_t k = i - 3; k <= i + 3; ++k) {
            seen += white[k] / 7;
        }
        CHECK(seen == test::near(whitened(dark[i], cover)).epsilon(0.08));
    }
}

TEST_CASE("whitecaps: they are the same whichever way waves run" * technique("water.whitecaps")) {
    // The pattern of breaking crests is not: means over the view.
    const WaterLook look = {.foam_below = 0.6f, .foam_decay = 1};
    const auto mean_of = [&](float direction) {
        Sea sea(direction);
        float sum = 0;
        for (const float column : sea.columns(look)) {
            sum += column / kSize;
        }
        return sum;
    };
    const auto along_x = static_cast<double>(mean_of(0));
    CHECK(along_x > 0.05);
    CHECK(static_cast<double>(mean_of(kPi / 2)) == test::near(along_x).epsilon(0.15).scale(0));
    CHECK(static_cast<double>(mean_of(kPi / 4)) == test::near(along_x).epsilon(0.15).scale(0));
}

TEST_CASE_FIXTURE(Sea, "whitecaps: they trail behind their crests" * technique("water.whitecaps")) {
    const std::vector<float> white = columns({.foam_below = 0.5f, .foam_decay = 1});
    CHECK(white[column_behind(1.6f)] > 1.5f * white[column_behind(-1.6f)]);
}

TEST_CASE_FIXTURE(Sea, "whitecaps: none where waves are not steep enough, or by default") {
    const std::vector<float> dark = columns({});
    CHECK(columns({.foam_below = -0.2f}) == dark);
    CHECK(columns({.foam_below = 0.8f}) != dark);
}

}  // namespace limn::test::whitecaps_test
