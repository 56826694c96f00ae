#include "content/make/patterns/studio_pattern.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn::studio_pattern_test {
namespace {

constexpr int kSize = 256;

/// Red of each texel, with the middle of the image straight ahead.
std::vector<std::uint8_t> reds(const StudioLight& light) {
    const PatternMaps maps = make_studio(
        {.image = {.size = kSize}, .wall = Vec3(0), .floor = Vec3(0), .lights = {light}});
    std::vector<std::uint8_t> values;
    for (std::size_t i = 0; i < maps.base_color.pixels.size(); i += 4) {
        values.push_back(maps.base_color.pixels[i]);
    }
    return values;
}

struct Spot {
    Vec2 middle = {0, 0};  ///< mean place of all light [texels]
    Vec2 extent = {0, 0};  ///< columns and rows with light
};

Spot spot_of(const std::vector<std::uint8_t>& values) {
    Spot spot;
    float sum = 0;
    std::vector<bool> columns(kSize), rows(kSize);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t x = i % kSize;
        const std::size_t y = i / kSize;
        spot.middle += Vec2(x, y) * static_cast<float>(values[i]);
        sum += static_cast<float>(values[i]);
        spot.extent +=
            Vec2(values[i] > 127 && !columns[x] ? 1 : 0, values[i] > 127 && !rows[y] ? 1 : 0);
        columns[x] = columns[x] || values[i] > 127;
        rows[y] = rows[y] || values[i] > 127;
    }
    spot.middle /= sum;
    return spot;
}

/// Stretches of light in a line of texels.
int stretches(const std::vector<std::uint8_t>& values, std::size_t first, std::size_t step) {
    int count = 0;
    bool lit = false;
    for (std::size_t i = 0; i < kSize; ++i) {
        const bool now = values[first + i * step] > 127;
        count += now && !lit ? 1 : 0;
        lit = now;
    }
    return count;
}

}  // namespace

TEST_CASE("studio: a light is at its longitude and latitude, of its apparent size") {
    const Vec3 directions[] = {
        {0, 0, -1}, {1, 0, 0}, {-1, 0, -0.5f}, {0.5f, 0.3f, -1}, {0.2f, -0.4f, 0.9f}};
    for (const Vec3& toward : directions) {
        CAPTURE(toward.x);
        CAPTURE(toward.z);
        const Spot spot = spot_of(reds({.toward = toward, .size = {0.2f, 0.2f}, .edge = 0}));
        const Vec3 d = glm::normalize(toward);
        const Vec2 place = {0.5f + std::atan2(d.x, -d.z) / (2 * kPi), 0.5f - std::asin(d.y) / kPi};
        CHECK(glm::length(spot.middle + 0.5f - place * float{kSize}) < 1.5f);
    }
    const Spot wide = spot_of(reds({.toward = {0, 0, -1}, .size = {2, 1}, .edge = 0}));
    CHECK(std::abs(wide.extent.x - kSize * 2 * std::atan(1.0f) / (2 * kPi)) <= 2);
    CHECK(std::abs(wide.extent.y - kSize * 2 * std::atan(0.5f) / kPi) <= 2);
}

TEST_CASE("studio: a window has panes, a soft box none; there is no light elsewhere") {
    const StudioLight window = {
        .toward = {0, 0, -1}, .size = {1.5f, 1.5f}, .edge = 0, .panes = {2, 3}, .bars = 0.2f};
    const std::vector<std::uint8_t> panes = reds(window);
    CHECK(stretches(panes, kSize * kSize / 2, 1) == 2);
    CHECK(stretches(panes, kSize / 2 + 12, kSize) == 3);
    StudioLight box = window;
    box.panes = {1, 1};
    CHECK(stretches(reds(box), kSize * kSize / 2, 1) == 1);
    for (const std::uint8_t value : reds({.toward = {0, 0, 0}})) {
        REQUIRE(value == 0);
    }
}

}  // namespace limn::studio_pattern_test
