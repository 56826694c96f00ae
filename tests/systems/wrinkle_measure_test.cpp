#include "systems/faces/wrinkle_measure.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace limn::wrinkle_measure_test {

using limn::test::near;

namespace {

using Positions = std::vector<Vec3>;
using Map = std::function<Vec3(Vec3)>;

const std::vector<std::uint32_t> kOne = {0, 1, 2};
const Positions kSkew = {{0, 0, 0}, {4, 1, 0}, {1, 3, 0}};

Positions mapped(const Positions& positions, const Map& map) {
    Positions result;
    std::ranges::transform(positions, std::back_inserter(result), map);
    return result;
}

WrinkleRest rest_of(const Positions& positions, const Vec3& across) {
    return make_wrinkle_rest(positions, kOne, std::vector<Vec3>(positions.size(), across));
}

float ratio_of(const WrinkleRest& rest, const Positions& deformed) {
    std::vector<float> ratio(rest.across.size());
    find_compression(rest, deformed, ratio);
    REQUIRE(!ratio.empty());
    return ratio[0];
}

/// Of `kSkew`, measured along x.
float skew_ratio(const Map& map) {
    return ratio_of(rest_of(kSkew, {1, 0, 0}), mapped(kSkew, map));
}

/// The longest chord of a triangle in a direction, as the source measures it: from the vertex that
/// is the one between, across the direction to a point a Vj + (1 - a) Vk of the previous edge.
struct Chord {
    int apex = 0;
    int j = 0;
    int k = 0;
    float a = 0;
    float length2 = 0;
};

Vec3 chord_of(const Chord& chord, const Positions& p) {
    return p[chord.apex] - (chord.a * p[chord.j] + (1 - chord.a) * p[chord.k]);
}

Chord find_chord(const Positions& p, const Vec3& across) {
    const Vec3 m = glm::cross(glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0])), across);
    std::array<int, 3> order = {0, 1, 2};
    std::ranges::sort(order, {}, [&](int i) { return glm::dot(m, p[i]); });
    const auto q = [&](int i) { return glm::dot(m, p[i]); };
    const auto [j, apex, k] = order;
    Chord chord = {.apex = apex, .j = j, .k = k, .a = (q(k) - q(apex)) / (q(k) - q(j))};
    const Vec3 along = chord_of(chord, p);
    chord.length2 = glm::dot(along, along);
    return chord;
}

class Random {
  public:
    float number(float low, float high) {
        return low + (high - low) * (static_cast<float>(engine_() >> 8) / 16777216.0f);
    }
    Vec3 vector() { return {number(-1, 1), number(-1, 1), number(-1, 1)}; }

  private:
    std::mt19937 engine_{7};
};

/// A fan of triangles about the first position, with the compression of each.
struct Fan {
    Positions positions;
    std::vector<std::uint32_t> indices;
    std::vector<float> ratio;
};

float mean_at_center(const Fan& fan, WrinkleWeight weight) {
    const std::vector<Vec3> across(fan.positions.size(), Vec3{1, 0.3f, 0});
    const WrinkleRest rest = make_wrinkle_rest(fan.positions, fan.indices, across, weight);
    std::vector<float> vertices(fan.positions.size());
    average_compression(rest, fan.ratio, vertices);
    return vertices[0];
}

}  // namespace

TEST_CASE(
    "wrinkle measure: the examples of chords, from the vertex in between to the opposite edge"
    * technique("wrinkle.compression.rest-measure")) {
    const auto check = [](const Positions& p, Vec3 across, int apex, Vec3 end, float length2) {
        const Chord chord = find_chord(p, across);
        CHECK(chord.apex == apex);
        CHECK(glm::length(p[apex] - chord_of(chord, p) - end) < 1e-6f);
        // Made longer to twice its length along `across`, the chord has four times its square.
        const WrinkleRest rest = rest_of(p, across);
        const Vec3 in_rest = rest.across[0].x * (p[1] - p[0]) + rest.across[0].y * (p[2] - p[0]);
        CHECK(glm::length(in_rest - across) < 1e-6f);
        CHECK(chord.length2 == near(length2));
    };
    check(kSkew, {1, 0, 0}, 1, {1.0f / 3, 1, 0}, 121.0f / 9);
    check(
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, Vec3{1, 1, 0} / std::sqrt(2.0f), 0, {0.5f, 0.5f, 0},
        0.5f);
    check({{0, 0, 0}, {2, 0, 0}, {1, 2, 0}}, {0, 1, 0}, 2, {1, 0, 0}, 4);
    const Vec2 found = rest_of(kSkew, {1, 0, 0}).across[0];
    CHECK(found.x == near(3.0 / 11));
    CHECK(found.y == near(-1.0 / 11));
}

TEST_CASE(
    "wrinkle measure: the ratio is that of the square of the chord, for any triangle and map"
    * technique("wrinkle.compression.rest-measure")) {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        const Positions p = {random.vector(), random.vector(), random.vector()};
        const Vec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
        if (glm::length(normal) < 0.1f) {
            continue;
        }
        const Vec3 across = glm::normalize(glm::cross(normal, random.vector()));
        const Positions deformed = {random.vector(), random.vector(), random.vector()};
        const Chord chord = find_chord(p, across);
        CHECK(chord.a >= 0);
        CHECK(chord.a <= 1);
        const Vec3 now = chord_of(chord, deformed);
        const float scale = 1 + glm::dot(now, now) / chord.length2;
        CHECK(
            std::abs(ratio_of(rest_of(p, across), deformed) - glm::dot(now, now) / chord.length2)
            <= 1e-4f * scale);
    }
}

TEST_CASE(
    "wrinkle measure: only shortening across the wrinkles counts"
    * technique("wrinkle.compression.factor")) {
    CHECK(skew_ratio([](Vec3 p) { return p; }) == near(1).epsilon(1e-6));
    CHECK(skew_ratio([](Vec3 p) { return p * Vec3{0.8f, 1, 1}; }) == near(0.64));
    CHECK(skew_ratio([](Vec3 p) { return p * Vec3{1, 0.5f, 1}; }) == near(1).epsilon(1e-6));
    CHECK(skew_ratio([](Vec3 p) { return p + Vec3{0.7f * p.y, 0, 0}; }) == near(1).epsilon(1e-6));
    CHECK(skew_ratio([](Vec3 p) { return p + Vec3{0, 0.5f * p.x, 0}; }) == near(1.25));
    CHECK(skew_ratio([](Vec3 p) { return 1.3f * p; }) == near(1.69));
    CHECK(skew_ratio([](Vec3) { return Vec3{2, 3, 4}; }) == 0);
    const Quat turn = glm::angleAxis(1.1f, glm::normalize(Vec3{1, 2, -1}));
    CHECK(skew_ratio([&](Vec3 p) { return turn * p + Vec3{3, -2, 5}; }) == near(1).epsilon(2e-6));
    CHECK(
        skew_ratio(
            [](Vec3 p) { return p.x > 3 ? Vec3{std::numeric_limits<float>::quiet_NaN()} : p; })
        == 1);
}

TEST_CASE(
    "wrinkle measure: directions have no sign, lie in the plane and are unit"
    * technique("wrinkle.compression.direction")) {
    Random random;
    for (int i = 0; i < 200; ++i) {
        const Positions p = {random.vector(), random.vector(), random.vector()};
        const Vec3 cross = glm::cross(p[1] - p[0], p[2] - p[0]);
        if (glm::length(cross) < 0.1f) {
            continue;
        }
        const Vec3 mean = random.vector();
        std::vector<Vec3> across = {
            mean + 0.2f * random.vector(), mean + 0.2f * random.vector(),
            mean + 0.2f * random.vector()};
        const Vec2 c = make_wrinkle_rest(p, kOne, across).across[0];
        const Vec3 direction = c.x * (p[1] - p[0]) + c.y * (p[2] - p[0]);
        CHECK(glm::length(direction) == near(1).epsilon(1e-5));
        CHECK(std::abs(glm::dot(direction, glm::normalize(cross))) < 1e-5f);
        const int flipped = i % 3;
        across[flipped] = -across[flipped];
        const Vec2 again = make_wrinkle_rest(p, kOne, across).across[0];
        CHECK(
            std::abs(glm::dot(again - c, again - c)) * std::abs(glm::dot(again + c, again + c))
            < 1e-8f * glm::dot(c, c));
    }
}

TEST_CASE(
    "wrinkle measure: triangles without area or direction, and NaN positions, count as 1"
    * technique("wrinkle.compression.factor")) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Positions shrunk = mapped(kSkew, [](Vec3 p) { return 0.5f * p; });
    CHECK(ratio_of(rest_of(kSkew, {0, 0, 1}), shrunk) == 1);
    CHECK(ratio_of(rest_of(kSkew, {0, 0, 0}), shrunk) == 1);
    CHECK(ratio_of(rest_of(kSkew, {nan, 0, 0}), shrunk) == 1);
    CHECK(ratio_of(rest_of({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {1, 0, 0}), shrunk) == 1);
    CHECK(ratio_of(rest_of({{0, 0, 0}, {nan, 1, 1}, {2, 2, 3}}, {1, 0, 0}), shrunk) == 1);
    CHECK(ratio_of(rest_of({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {1, 0, 0}), shrunk) == 1);
    const std::vector<Vec3> along_x(3, {1, 0, 0});
    CHECK(make_wrinkle_rest(kSkew, std::vector<std::uint32_t>{0, 1, 3}, along_x).across.empty());

    const WrinkleRest none = rest_of(kSkew, {0, 0, 1});
    std::vector<float> vertices(3, 0.0f);
    average_compression(none, std::vector<float>{0.3f}, vertices);
    CHECK(vertices == std::vector<float>{1, 1, 1});
}

TEST_CASE(
    "wrinkle measure: an edge of three triangles and one triangle twice are measured as others") {
    // A page in a book: all are shortened equally, so every mean is the same.
    const Positions book = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}};
    const std::vector<std::uint32_t> pages = {0, 1, 2, 0, 1, 3, 0, 1, 4, 0, 1, 2};
    const WrinkleRest rest =
        make_wrinkle_rest(book, pages, std::vector<Vec3>(book.size(), Vec3(0, 1, 0)));
    const Positions shorter = mapped(book, [](Vec3 p) { return p * Vec3(1, 0.9f, 1); });
    for (const float ratio : vertex_compression({&rest, 1}, shorter)) {
        CHECK(ratio == near(0.81).epsilon(1e-5));
    }
    // A triangle with an index out of range is ignored.
    const std::vector<std::uint32_t> beyond = {0, 1, 2, 0, 1, 77};
    const WrinkleRest cut =
        make_wrinkle_rest(book, beyond, std::vector<Vec3>(book.size(), Vec3(0, 1, 0)));
    CHECK(vertex_compression({&cut, 1}, shorter)[0] == near(0.81).epsilon(1e-5));
}

TEST_CASE(
    "wrinkle measure: with angle weights, the subdivision of a fan does not matter"
    * technique("wrinkle.compression.vertex-weight")) {
    // Four right angles about a point, the last one compressed to a half.
    Fan four{
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
        {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1},
        {1, 1, 1, 0.5f}};
    Fan halved = four;  // through the point
    halved.positions.push_back({0.5f, -0.5f, 0});
    halved.indices = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0, 5, 1};
    halved.ratio = {1, 1, 1, 0.5f, 0.5f};
    Fan cut = four;  // parallel to the far edge, halfway; only the near quarter is at the point
    cut.positions.push_back({0, -0.5f, 0});
    cut.positions.push_back({0.5f, 0, 0});
    cut.indices = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 5, 6};
    using enum WrinkleWeight;
    CHECK(mean_at_center(four, Angle) == near(0.875));
    CHECK(mean_at_center(four, Area) == near(0.875));
    CHECK(mean_at_center(four, Uniform) == near(0.875));
    CHECK(mean_at_center(halved, Angle) == near(0.875));
    CHECK(mean_at_center(halved, Area) == near(0.875));
    CHECK(mean_at_center(halved, Uniform) == near(0.8));
    CHECK(mean_at_center(cut, Angle) == near(0.875));
    CHECK(mean_at_center(cut, Area) == near(3.125 / 3.25));
    CHECK(mean_at_center(cut, Uniform) == near(0.875));
}

TEST_CASE(
    "wrinkle measure: weights at a vertex sum to 1, and a mean lies between its parts"
    * technique("wrinkle.compression.vertex-weight")) {
    Random random;
    Positions p;
    std::vector<std::uint32_t> indices;
    constexpr std::uint32_t kWide = 8;
    for (std::uint32_t y = 0; y < kWide; ++y) {
        for (std::uint32_t x = 0; x < kWide; ++x) {
            p.push_back(Vec3(x, y, 0) + 0.3f * random.vector());
            if (x + 1 < kWide && y + 1 < kWide) {
                const std::uint32_t v = y * kWide + x;
                indices.insert(
                    indices.end(), {v, v + 1, v + kWide, v + 1, v + kWide + 1, v + kWide});
            }
        }
    }
    const WrinkleRest rest = make_wrinkle_rest(p, indices, std::vector<Vec3>(p.size(), {1, 0, 0}));
    std::vector<float> ratio(rest.across.size());
    std::ranges::generate(ratio, [&] { return random.number(0.2f, 2.0f); });
    std::vector<float> vertices(p.size());
    average_compression(rest, ratio, vertices);
    for (std::size_t v = 0; v < p.size(); ++v) {
        float sum = 0;
        float lowest = 10;
        float highest = 0;
        for (std::uint32_t i = rest.first[v]; i < rest.first[v + 1]; ++i) {
            sum += rest.around[i].weight;
            lowest = std::min(lowest, ratio[rest.around[i].corner / 3]);
            highest = std::max(highest, ratio[rest.around[i].corner / 3]);
        }
        CHECK(sum == near(1).epsilon(1e-6));
        CHECK(vertices[v] >= lowest * (1 - 1e-6f));
        CHECK(vertices[v] <= highest * (1 + 1e-6f));
    }
}

TEST_CASE(
    "wrinkle measure: vertices duplicated at a seam get the mean of both sides"
    * technique("wrinkle.compression.vertex-weight")) {
    // Two triangles with the edge x = 1 twice; the right one is compressed.
    const Positions p = {{0, -1, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, 0}, {2, 1, 0}, {1, 1, 0}};
    const std::vector<std::uint32_t> indices = {0, 1, 2, 3, 4, 5};
    const WrinkleRest rest = make_wrinkle_rest(p, indices, std::vector<Vec3>(6, {1, 0, 0}));
    std::vector<float> vertices(6);
    average_compression(rest, std::vector<float>{1, 0.5f}, vertices);
    CHECK(vertices[1] == vertices[3]);
    CHECK(vertices[2] == vertices[5]);
    CHECK(vertices[1] == near((135 + 0.5 * 45) / 180));
    CHECK(vertices[2] == near((26.565051 + 0.5 * 90) / 116.565051));
    CHECK(vertices[0] == 1);
    CHECK(vertices[4] == 0.5f);
}

TEST_CASE(
    "wrinkle measure: skin without a direction folds by the mean of all of them"
    * technique("wrinkle.dimples")) {
    const std::vector<Vec3> none(3, Vec3(0));
    const std::vector<float> aside(3, 0.5f);
    const WrinkleRest rest = make_wrinkle_rest(
        kSkew, kOne, none, WrinkleWeight::Angle, {.aside = aside, .narrowing = 0});
    Random random;
    for (int i = 0; i < 30; ++i) {
        const Vec3 row = random.vector();
        const Vec3 other = random.vector();
        const Positions deformed = mapped(kSkew, [&](Vec3 p) { return p.x * row + p.y * other; });
        float mean = 0;
        constexpr int kDirections = 64;
        for (int k = 0; k < kDirections; ++k) {
            const float angle = kPi * static_cast<float>(k) / kDirections;
            const Vec3 chord = std::cos(angle) * row + std::sin(angle) * other;
            mean += glm::dot(chord, chord) / kDirections;
        }
        for (const float ratio : vertex_compression({&rest, 1}, deformed)) {
            CHECK(ratio == near(mean).epsilon(1e-4));
        }
    }
    // As much longer in one direction as it is shorter in the other, it does not.
    const Positions sheared =
        mapped(kSkew, [](Vec3 p) { return Vec3(0.8f * p.x, 1.25f * p.y, 0); });
    CHECK(vertex_compression({&rest, 1}, sheared)[0] > 1);
}

TEST_CASE(
    "wrinkle measure: skin that is stretched along its folds narrows without folding"
    * technique("wrinkle.natural-width")) {
    constexpr float kPoisson = 0.5f;
    const std::vector<Vec3> across(3, Vec3{1, 0, 0});
    const WrinkleRest rest = make_wrinkle_rest(
        kSkew, kOne, across, WrinkleWeight::Angle, {.aside = {}, .narrowing = kPoisson});
    const auto ratio = [&](float wide, float high) {
        return vertex_compression(
            {&rest, 1}, mapped(kSkew, [&](Vec3 p) { return Vec3(wide * p.x, high * p.y, 0); }))[0];
    };
    CHECK(ratio(1, 1) == near(1));
    for (const float wide : {0.7f, 0.9f, 1.2f}) {
        CHECK(ratio(wide, 1) == near(wide * wide));
    }
    for (const float high : {1.01f, 1.03f}) {
        CHECK(ratio(std::pow(high, -kPoisson), high) == near(1).epsilon(2e-3));
        CHECK(ratio(std::pow(high, -kPoisson) - 0.05f, high) < 0.92f);
    }
    CHECK(ratio(1, 1.2f) == near(1 + kPoisson * (1.44f - 1)));
    CHECK(ratio(0.9f, 0.8f) == near(0.81));  // where it is compressed along them, too, it is not
}

TEST_CASE(
    "wrinkle measure: where regions overlap the direction turns from one to the other"
    * technique("wrinkle.dimples")) {
    constexpr std::size_t kSteps = 41;
    const auto merged = [&](bool second_has_direction) {
        MeshData mesh;
        VertexRegion first = {.name = "first", .weights = {}, .across = {}};
        VertexRegion second = {.name = "second", .weights = {}, .across = {}};
        const float angle = radians(60.0f);
        for (std::size_t i = 0; i < kSteps; ++i) {
            const float x = static_cast<float>(i) / (kSteps - 1);
            mesh.positions.emplace_back(x, 0, 0);
            mesh.normals.emplace_back(0, 0, 1);
            first.weights.push_back(1 - x);
            second.weights.push_back(x);
            first.across.emplace_back(1, 0, 0);
            if (second_has_direction) {
                second.across.emplace_back(-std::cos(angle), -std::sin(angle), 0);
            }
        }
        mesh.regions = {first, second};
        return merge_regions(mesh, {}, false);
    };
    const auto angle_at = [](const FoldField& field, std::size_t i) {
        const float angle = degrees(std::atan2(field.across[i].y, field.across[i].x));
        return std::fmod(angle + 270.0f, 180.0f) - 90.0f;
    };
    const FoldField turned = merged(true);
    CHECK(angle_at(turned, 0) == 0);
    CHECK(angle_at(turned, kSteps / 2) == near(30).epsilon(1e-4));
    CHECK(angle_at(turned, kSteps - 1) == near(60).epsilon(1e-4));
    CHECK(turned.aside[kSteps / 2] == near(0.25).epsilon(1e-4));
    for (std::size_t i = 1; i < kSteps; ++i) {
        CHECK(angle_at(turned, i) > angle_at(turned, i - 1));
        CHECK(angle_at(turned, i) - angle_at(turned, i - 1) < 3);
    }
    // The other one has no direction.
    const FoldField any = merged(false);
    CHECK(any.aside[0] == 0);
    CHECK(any.aside[kSteps / 2] == near(0.25).epsilon(1e-4));
    CHECK(any.aside[kSteps - 1] == 0.5f);
    CHECK(any.across[kSteps - 1] == Vec3(0));
}

TEST_CASE(
    "wrinkle intensity: the values of the table" * technique("wrinkle.compression.intensity")) {
    struct Row {
        float lambda, beta, ratio, expected;
    };
    const std::vector<Row> rows = {
        {1, 1, 0.25f, 0.6f},         {1, 1, 0.5f, 1.0f / 3},    {1, 1, 2, -1.0f / 3},
        {1, 2, 0.5f, 0.6f},          {1, 2, 0.64f, 0.418842f},  {1, 2, 0.9f, 0.104972f},
        {1, 4, 0.5f, 0.882353f},     {1, 4, 0.64f, 0.712663f},  {1, 4, 0.81f, 0.398145f},
        {1, 4, 0.9f, 0.207657f},     {1, 4, 1.1f, -0.188345f},  {1, 4, 1.25f, -0.418842f},
        {1, 4, 1.5625f, -0.712663f}, {1, 8, 0.81f, 0.687334f},  {0.8f, 4, 1, 0.418842f},
        {0.8f, 4, 1.25f, 0},         {1.25f, 4, 0.8f, 0},       {1.25f, 4, 0.64f, 0.418842f},
        {1.25f, 4, 1, -0.418842f},   {1, 2, 0.57735027f, 0.5f}, {1, 4, 0.7598357f, 0.5f},
        {1, 8, 0.8716855f, 0.5f},    {0.8f, 4, 0, 1},           {3, 0.5f, 0, 1}};
    for (const Row& row : rows) {
        CAPTURE(row.lambda);
        CAPTURE(row.beta);
        CAPTURE(row.ratio);
        CHECK(
            wrinkle_intensity(row.ratio, row.lambda, row.beta)
            == near(row.expected).epsilon(1e-6).scale(1));
    }
}

TEST_CASE(
    "wrinkle intensity: it falls with the ratio, odd about its zero, and never overflows"
    * technique("wrinkle.compression.intensity")) {
    for (const float lambda : {0.7f, 1.0f, 1.05f}) {
        for (const float beta : {1.0f, 4.0f, 8.0f}) {
            float before = 2;
            for (float ratio = 0.2f; ratio < 4; ratio *= 1.1f) {
                const float found = wrinkle_intensity(ratio, lambda, beta);
                CHECK(found < before);
                before = found;
                CHECK(
                    found + wrinkle_intensity(1 / (lambda * lambda * ratio), lambda, beta)
                    == near(0).scale(1));
                CHECK(found == near(2 / (1 + std::pow(lambda * ratio, beta)) - 1).scale(1));
            }
            const float step = 1e-2f / lambda;
            const float slope = (wrinkle_intensity(1 / lambda + step, lambda, beta)
                                 - wrinkle_intensity(1 / lambda - step, lambda, beta))
                                / (2 * step);
            CHECK(slope == near(-beta * lambda / 2).epsilon(2e-3));
        }
    }
    CHECK(wrinkle_intensity(1e30f, 100, 50) == -1);
}

TEST_CASE(
    "wrinkle intensity: of lengths, by the square of lambda and half of beta, it is the same"
    * technique("wrinkle.compression.square-length")) {
    for (float ratio = 0.1f; ratio < 3; ratio += 0.1f) {
        CHECK(
            wrinkle_intensity(ratio, 1.1f * 1.1f, 2)
            == near(wrinkle_intensity(std::sqrt(ratio), 1.1f, 4)).epsilon(1e-6).scale(1));
    }
}

}  // namespace limn::wrinkle_measure_test
