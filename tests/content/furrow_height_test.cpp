#include "content/bake/furrow_height.h"
#include "content/bake/furrow_map.h"
#include "content/bake/furrow_presets.h"
#include "content/bake/furrow_recipe.h"
#include "content/make/models/shapes.h"
#include "ecs/base/hash.h"
#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "tests/content/furrow_shapes.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace limn::furrow_height_test {
namespace {

const FurrowMap& skin_map() {
    static const FurrowMap map =
        test::make_flat_furrow_map({200, 150}, {0.7f, 0.9f}, {-1.0f, 0.5f});
    return map;
}

double mean_of(const std::vector<float>& values) {
    double sum = 0;
    for (const float value : values) {
        sum += static_cast<double>(value);
    }
    return sum / static_cast<double>(values.size());
}

template <typename T>
std::uint64_t bits(const std::vector<T>& values) {
    return hash_bytes(values.data(), values.size() * sizeof(T), 0);
}

/// Equation 4.11 with its cross products.
Vec3 perturbed_by_cross_products(const Vec3& n, const Vec2& slope) {
    return n + slope.x * glm::cross(n, Vec3(0, n.z, -n.y))
           + slope.y * glm::cross(Vec3(n.z, 0, -n.x), n);
}

/// The growth of a map without furrows.
FurrowGrowth make_smooth_growth(const FurrowMap& map) {
    FurrowStyle style;
    style.functions.depth = 0;
    return grow_furrows(map, style);
}

}  // namespace

TEST_CASE(
    "furrow height: without noise it is the minimum of both fields, within 0 to 1"
    * technique("wrinkle.furrow.heightfield")) {
    const FurrowGrowth growth = grow_furrows(skin_map(), {});
    std::size_t first_lower = 0;
    std::size_t second_lower = 0;
    for (std::size_t i = 0; i < growth.height.size(); ++i) {
        CHECK(growth.height[i] == std::min(growth.first[i], growth.second[i]));
        CHECK(growth.height[i] >= 0.0f);
        CHECK(growth.height[i] <= 1.0f);
        first_lower += growth.first[i] < growth.second[i] ? 1 : 0;
        second_lower += growth.second[i] < growth.first[i] ? 1 : 0;
    }
    CHECK(first_lower > 2000);
    CHECK(second_lower > 2000);
    CHECK(add_furrow_noise(growth, {}) == growth.height);
}

TEST_CASE(
    "furrow height: swapping the fields with their random numbers gives the same height"
    * technique("wrinkle.furrow.heightfield")) {
    FurrowMap swapped = skin_map();
    std::swap(swapped.stream[0], swapped.stream[1]);
    for (FurrowTriangle& t : swapped.triangles) {
        std::swap(t.field[0], t.field[1]);
    }
    const FurrowGrowth a = grow_furrows(skin_map(), {});
    const FurrowGrowth b = grow_furrows(swapped, {});
    CHECK(a.height == b.height);
    CHECK(a.first == b.second);
    std::swap(swapped.stream[0], swapped.stream[1]);
    CHECK(grow_furrows(swapped, {}).height != a.height);
}

TEST_CASE(
    "furrow height: a field of magnitude 0 changes nothing, one of 2 goes to the bottom"
    * technique("wrinkle.furrow.heightfield")) {
    const FurrowMap still = test::make_flat_furrow_map({40, 40}, {0, 0}, {0, 0});
    for (const float h : grow_furrows(still, {}).height) {
        CHECK(h == 1.0f);
    }
    const FurrowMap deep = test::make_flat_furrow_map({60, 60}, {2, 0}, {0, 0});
    const FurrowGrowth growth = grow_furrows(deep, {});
    CHECK(*std::min_element(growth.height.begin(), growth.height.end()) < 1e-6f);
    CHECK(mean_of(growth.height) > 0.6);
}

TEST_CASE(
    "furrow noise: heights fall by uniform random fractions of it, always from the same start"
    * technique("wrinkle.furrow.noise")) {
    const FurrowGrowth growth = grow_furrows(skin_map(), {});
    FurrowStyle style;
    style.noise = 0.3f;
    const std::vector<float> noisy = add_furrow_noise(growth, style);
    for (std::size_t i = 0; i < noisy.size(); ++i) {
        CHECK(noisy[i] <= growth.height[i]);
        CHECK(noisy[i] >= growth.height[i] - 0.3f);
    }
    const double n = static_cast<double>(noisy.size());
    const double decrease = mean_of(growth.height) - mean_of(noisy);
    CHECK(std::abs(decrease - 0.15) < 3 * 0.3 / std::sqrt(12.0 * n));
    CHECK(add_furrow_noise(growth, style) == noisy);
    style.noise = 0.6f;
    CHECK(
        mean_of(growth.height) - mean_of(add_furrow_noise(growth, style))
        == test::near(2 * decrease).epsilon(1e-4));
    style = {.noise = 0.3f, .seed = 4};
    CHECK(add_furrow_noise(growth, style) != noisy);
}

TEST_CASE(
    "furrow normals: base normals are unit, exact at vertices and linear between them"
    * technique("wrinkle.furrow.normal-base")) {
    const MeshData ball = make_sphere({.radius = 1, .segments = 32, .rings = 16});
    const auto field = make_furrow_field(ball.positions, ball.normals, {});
    const auto map =
        make_furrow_map(ball, field, {.projection = FurrowProjection::Planar, .size = 256});
    REQUIRE(map.ok());
    const FurrowGrowth growth = make_smooth_growth(*map);
    const std::vector<Vec3> normals = make_furrow_base_normals(*map, growth);
    std::size_t covered = 0;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            const auto pixel = static_cast<std::size_t>(y * 256 + x);
            const Vec3& n = normals[pixel];
            CHECK(glm::length(n) == test::near(1.0f));
            if (growth.cover[pixel] < 0) {
                CHECK(n == Vec3(0, 0, 1));
                continue;
            }
            ++covered;
            const Vec2 p = (Vec2(x, y) + 0.5f - 128.0f) / (128.0f * 0.98f);  // on the ball
            CHECK(std::abs(n.x - p.x) < 0.02f);
            CHECK(std::abs(n.y + p.y) < 0.02f);
        }
    }
    CHECK(static_cast<double>(covered) == test::near(3.1416 * square(128 * 0.98)).epsilon(0.02));
    FurrowMap slope = test::make_flat_furrow_map({5, 5}, {1, 0});
    for (FurrowTriangle& t : slope.triangles) {
        t.normal = {0, 0.6f, 0.8f};
        t.normal_right = {0.1f, 0, 0};
    }
    const auto tilted = make_furrow_base_normals(slope, make_smooth_growth(slope));
    CHECK(glm::length(tilted[3] - glm::normalize(Vec3(0.35f, 0.6f, 0.8f))) < 1e-6f);
}

TEST_CASE(
    "furrow normals: the perturbed normal is Equation 4.11, and never turns back"
    * technique("wrinkle.furrow.normal-perturb")) {
    CHECK(
        glm::length(perturb_furrow_normal({0, 0, 1}, {0.3f, -0.2f}) - Vec3(-0.3f, 0.2f, 1))
        < 1e-7f);
    CHECK(
        glm::length(
            perturb_furrow_normal({0.6f, 0, 0.8f}, {0.5f, -0.25f}) - Vec3(0.28f, 0.25f, 1.04f))
        < 1e-6f);
    Random random(9, 0, 0, 0);
    for (int i = 0; i < 10000; ++i) {
        const Vec3 n = random.direction();
        const Vec2 slope(random.uniform(-1, 1), random.uniform(-1, 1));
        const Vec3 perturbed = perturb_furrow_normal(n, slope);
        CHECK(glm::dot(perturbed, n) == test::near(1.0f).epsilon(1e-5));
        CHECK(glm::length(perturbed - perturbed_by_cross_products(n, slope)) < 1e-6f);
    }
}

TEST_CASE(
    "furrow normals: slopes to the right and upwards tilt normals against them"
    * technique("wrinkle.furrow.normal-perturb")) {
    const FurrowMap map = test::make_flat_furrow_map({9, 7}, {1, 0});
    const FurrowGrowth growth = make_smooth_growth(map);
    std::vector<float> height(63);
    for (std::size_t i = 0; i < 63; ++i) {  // rises by 0.02 to the right and 0.05 upwards
        height[i] = 0.02f * static_cast<float>(i % 9) - 0.05f * static_cast<float>(i / 9);
    }
    const auto normals = make_furrow_normals(map, growth, height, 0.5f);
    CHECK(glm::length(normals[3 * 9 + 4] - glm::normalize(Vec3(-0.01f, -0.025f, 1))) < 1e-6f);
    // There are no slopes across the borders.
    CHECK(glm::length(normals[0 * 9 + 4] - glm::normalize(Vec3(-0.01f, 0, 1))) < 1e-6f);
    CHECK(glm::length(normals[3 * 9 + 8] - glm::normalize(Vec3(0, -0.025f, 1))) < 1e-6f);
    FurrowMap repeating = map;
    repeating.wrap_s = repeating.wrap_t = true;
    const auto wrapped = make_furrow_normals(repeating, growth, height, 0.5f);
    CHECK(glm::length(wrapped[0 * 9 + 8] - glm::normalize(Vec3(0.08f, 0.15f, 1))) < 1e-6f);
}

TEST_CASE(
    "furrow normals: without height or bump they are the base normals"
    * technique("wrinkle.furrow.normal-perturb")) {
    const FurrowGrowth growth = grow_furrows(skin_map(), {});
    const auto base = make_furrow_base_normals(skin_map(), growth);
    CHECK(make_furrow_normals(skin_map(), growth, growth.height, 0) == base);
    const std::vector<float> flat(growth.height.size(), 0.4f);
    CHECK(make_furrow_normals(skin_map(), growth, flat, 1) == base);
    CHECK(make_furrow_normals(skin_map(), growth, growth.height, 1) != base);
}

TEST_CASE(
    "furrow height: it is bit-identical for any number of threads"
    * technique("wrinkle.furrow.heightfield")) {
    const int threads = thread_count();
    const FurrowStyle style = {.noise = 0.2f};
    std::uint64_t found[3] = {};
    for (int i = 0; i < 3; ++i) {
        set_thread_count(1 + 2 * i);
        set_task_shuffle(static_cast<std::uint64_t>(i));
        const FurrowGrowth growth = grow_furrows(skin_map(), style);
        const std::vector<float> noisy = add_furrow_noise(growth, style);
        found[i] =
            hash_combine(bits(noisy), bits(make_furrow_normals(skin_map(), growth, noisy, 0.5f)));
    }
    set_task_shuffle(0);
    set_thread_count(threads);
    CHECK(found[0] == found[1]);
    CHECK(found[0] == found[2]);
}

TEST_CASE("furrow maps: the border extends beyond the surface by the requested number of rings") {
    FurrowMap map = test::make_flat_furrow_map({40, 40}, {1, 0}, {0, 1});
    map.triangles.resize(1);  // x > y
    const FurrowMaps bare = make_furrow_maps(map, {.bump = 1});
    FurrowMaps maps = bare;
    add_furrow_gutter(maps, 3);
    int changed = 0;
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 40; ++x) {
            const auto pixel = static_cast<std::size_t>(y * 40 + x);
            CHECK(glm::length(maps.normals[pixel]) == test::near(1.0f));
            if (x >= y || y - x > 6) {  // a ring reaches two diagonals further
                CHECK(maps.height[pixel] == bare.height[pixel]);
                CHECK(maps.normals[pixel] == bare.normals[pixel]);
            } else if (y - x == 1 && x > 0 && y < 39) {  // seven neighbors, of which some are skin
                float lowest = 1;
                for (const int to : {-40, 1, -39, -41, 41}) {
                    const auto near = static_cast<std::size_t>(static_cast<int>(pixel) + to);
                    lowest = std::min(lowest, bare.growth.cover[near] < 0 ? 1 : bare.height[near]);
                }
                CHECK(maps.height[pixel] >= lowest);
            }
            changed += maps.height[pixel] != bare.height[pixel] ? 1 : 0;
        }
    }
    CHECK(changed > 40);
}

TEST_CASE("furrow presets: they are the rows of Table 6.2" * technique("wrinkle.furrow.presets")) {
    struct Row {
        const char* figure;
        float noise, bump, melanin, blood, specular, shininess, scale;
    };
    const Row table[] = {
        {"6.1", 0.0f, 0.5f, 0.2f, 0.5f, 0.2f, 100, 1.1f},
        {"6.2", 0.0f, 0.5f, 0.2f, 0.5f, 0.2f, 100, 1.0f},
        {"6.3", 0.0f, 0.5f, 0.2f, 0.5f, 0.2f, 100, 0.8f},
        {"6.4", 0.0f, 1.0f, 0.2f, 0.5f, 0.2f, 100, 1.1f},
        {"6.5a", 0.0f, 0.3f, 0.2f, 0.5f, 0.2f, 100, 1.1f},
        {"6.5b", 0.0f, 0.8f, 0.2f, 0.5f, 0.2f, 100, 1.1f},
        {"6.6a", 0.0f, 0.3f, 0.2f, 0.5f, 0.3f, 100, 1.0f},
        {"6.6b", 0.3f, 0.3f, 0.2f, 0.5f, 0.3f, 100, 1.0f},
        {"6.7a", 0.0f, 0.5f, 0, 0, 0, 0, 0.8f},
        {"6.7b", 0.0f, 0.5f, 0, 0, 0, 0, 0.8f},
        {"6.7c", 0.0f, 0.5f, 0.05f, 0.2f, 0.1f, 120, 0.8f},
        {"6.7d", 0.0f, 0.5f, 0.5f, 0.6f, 0.4f, 70, 0.8f},
    };
    REQUIRE(furrow_presets().size() == std::size(table));
    for (std::size_t i = 0; i < std::size(table); ++i) {
        const FurrowPreset& preset = furrow_presets()[i];
        const Row& row = table[i];
        INFO(std::string(row.figure));
        CHECK(std::string(preset.figure) == row.figure);
        CHECK(preset.noise == row.noise);
        CHECK(preset.bump == row.bump);
        CHECK(preset.melanin == row.melanin);
        CHECK(preset.blood == row.blood);
        CHECK(preset.specular == row.specular);
        CHECK(preset.shininess == row.shininess);
        CHECK(preset.scale == row.scale);
        const bool measured = row.shininess == 0;
        CHECK((preset.lighting != FurrowLighting::Blinn) == measured);
    }
}

TEST_CASE(
    "furrow presets: faint and distinct differ in bump alone, smooth and rough in noise"
    * technique("wrinkle.furrow.presets")) {
    const auto style = [](std::string_view name) {
        for (const FurrowPreset& preset : furrow_presets()) {
            if (preset.name == name) {
                return with_preset({}, preset);
            }
        }
        return FurrowStyle{};
    };
    FurrowStyle distinct = style("distinct");
    CHECK(!needs_growth(style("faint"), distinct));
    CHECK(distinct.bump != style("faint").bump);
    CHECK(distinct.noise == style("faint").noise);
    const FurrowStyle rough = style("rough");
    CHECK(!needs_growth(style("smooth"), rough));
    CHECK(rough.noise != style("smooth").noise);
    CHECK(rough.bump == style("smooth").bump);
    CHECK(needs_growth(style("smooth"), style("hand")));  // another scale
    distinct.functions.limit.x += 1;
    CHECK(needs_growth(style("faint"), distinct));
}

}  // namespace limn::furrow_height_test
