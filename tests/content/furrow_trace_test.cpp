#include "content/bake/furrow_trace.h"
#include "ecs/base/rng.h"
#include "tests/content/furrow_shapes.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace limn::furrow_trace_test {
namespace {

FurrowStyle make_straight_style() {
    FurrowStyle style;
    style.functions.angle = {0, 0};
    return style;
}

/// The drawing and its segments.
struct Traced : FurrowDrawing {
    std::vector<FurrowSegment> segments = {};
};

/// Half a furrow from `start` in an empty image.
Traced trace_half(const FurrowMap& map, const FurrowStyle& style, const Vec2& start) {
    Traced traced = {make_furrow_drawing(map)};
    trace_half_furrow(
        map, cover_furrow_map(map), style, 0, 1, start, false, traced, &traced.segments);
    return traced;
}

float length_of(const Traced& drawing) {
    float length = 0;
    for (const FurrowSegment& s : drawing.segments) {
        length += glm::distance(s.from, s.to);
    }
    return length;
}

Traced trace_all(const FurrowMap& map, const FurrowStyle& style, int field = 0) {
    Traced traced;
    static_cast<FurrowDrawing&>(traced) =
        trace_furrows(map, cover_furrow_map(map), style, field, &traced.segments);
    return traced;
}

std::size_t count_furrows(const Traced& drawing) {
    std::set<std::uint32_t> ids;
    for (const FurrowSegment& s : drawing.segments) {
        ids.insert(s.furrow);
    }
    return ids.size();
}

float distance_to_segment(const Vec2& p, const FurrowSegment& s) {
    const Vec2 along = s.to - s.from;
    const float length2 = glm::dot(along, along);
    const float t =
        length2 > 0 ? std::clamp(glm::dot(p - s.from, along) / length2, 0.0f, 1.0f) : 0.0f;
    return glm::distance(p, s.from + t * along);
}

}  // namespace

TEST_CASE(
    "furrow functions: they are those of Table 3.1 and Equations 5.1 to 5.6"
    * technique("wrinkle.furrow.functions")) {
    struct Row {
        float x, angle, length, density, width, depth;
        int limit;
    };
    for (const Row& row :
         {Row{0, 1.0f, 4, 1, 0, 0, 30}, Row{0.5f, 0.8f, 4.5f, 4, 0.5f, 0.0625f, 25},
          Row{1, 0.6f, 5, 7, 1, 0.25f, 20}, Row{1.5f, 0.4f, 5.5f, 10, 1.5f, 0.5625f, 15},
          Row{2, 0.2f, 6, 13, 2, 1, 10}, Row{3.5f, 0.2f, 6, 13, 2, 1, 10}}) {  // clamped to 2
        for (const float k : {0.5f, 1.0f, 2.0f}) {
            FurrowStyle style;
            style.scale = k;
            const FurrowShape shape = furrow_shape(style, row.x);
            CHECK(shape.angle == test::near(row.angle));
            CHECK(shape.length == test::near(k * row.length));
            CHECK(shape.density == test::near(k * row.density));
            CHECK(shape.width == test::near(k * row.width).scale(1));
            CHECK(shape.depth == test::near(row.depth).scale(1));
            CHECK(shape.limit == row.limit);
        }
    }
}

TEST_CASE(
    "furrow functions: no style makes furrows stand still or turn back"
    * technique("wrinkle.furrow.trace")) {
    FurrowStyle style;
    style.functions.length = {0, 0};
    style.functions.density = {1, -6};
    for (const float x : {0.0f, 1.0f, 2.0f}) {
        CHECK(furrow_shape(style, x).length == kMinFurrowStep);
        CHECK(furrow_shape(style, x).density >= 0);
    }
    style.literal_turn = true;
    style.functions.angle = {1.2f, 1.2f};
    CHECK(furrow_shape(style, 2).angle == kMaxFurrowTurn);
    const FurrowMap map = test::make_flat_furrow_map({40, 40}, {2, 0});
    for (const std::uint32_t cell : trace_all(map, style).cells) {
        CHECK((cell & kFurrowBand) != 0);
    }
}

TEST_CASE(
    "furrow trace: half a furrow that nothing stops has limit + 1 segments in a line"
    * technique("wrinkle.furrow.functions, wrinkle.furrow.trace")) {
    const FurrowStyle style = make_straight_style();
    for (const auto& [x, segments, length] :
         {std::tuple{0.001f, 30, 120.0f}, std::tuple{0.5f, 26, 117.0f},
          std::tuple{1.0f, 21, 105.0f}, std::tuple{1.5f, 16, 88.0f}, std::tuple{2.0f, 11, 66.0f}}) {
        const FurrowMap map = test::make_flat_furrow_map({200, 40}, {x, 0});
        const Traced drawing = trace_half(map, style, {20.5f, 20.5f});
        CHECK(drawing.segments.size() == static_cast<std::size_t>(segments));
        CHECK(length_of(drawing) == test::near(length).epsilon(1e-3));
        for (const FurrowSegment& s : drawing.segments) {
            CHECK(s.to.y == 20.5f);
            CHECK(!s.met);
        }
    }
}

TEST_CASE(
    "furrow trace: a wall 12 px ahead ends a furrow there, in its third segment"
    * technique("wrinkle.furrow.trace")) {
    const FurrowMap map = test::make_flat_furrow_map({100, 40}, {1, 0});
    auto cover = cover_furrow_map(map);
    Traced drawing = {make_furrow_drawing(map)};
    for (std::size_t y = 0; y < 40; ++y) {
        drawing.cells[y * 100 + 32] = 77;  // another furrow, from x = 32 to 33
    }
    trace_half_furrow(
        map, cover, make_straight_style(), 0, 5, {20, 20.5f}, false, drawing, &drawing.segments);
    REQUIRE(drawing.segments.size() == 3);
    CHECK(drawing.segments[2].met);
    CHECK(drawing.segments[2].to.x == test::near(32));
    CHECK(drawing.cells[20 * 100 + 32] == (77 | kFurrowBand));
    // The border of the surface is a wall as well, and the other half runs in the opposite
    // direction.
    Traced other = {make_furrow_drawing(map)};
    trace_half_furrow(
        map, cover, make_straight_style(), 0, 5, {18, 20.5f}, true, other, &other.segments);
    REQUIRE(other.segments.size() == 4);
    CHECK(other.segments[3].met);
    CHECK(other.segments[3].to.x == test::near(0).scale(1));
}

TEST_CASE(
    "furrow trace: the smallest limit along the furrow counts"
    * technique("wrinkle.furrow.trace")) {
    FurrowMap map = test::make_flat_furrow_map({300, 40}, {0.05f, 0});
    FurrowTriangle strong = map.triangles[0];
    strong.field[0] = {2, 0};
    strong.corner[0] = {24, 0};
    strong.corner[1] = {300, 0};
    strong.corner[2] = {24, 400};
    map.triangles.insert(map.triangles.begin(), strong);
    const Traced drawing = trace_half(map, make_straight_style(), {20.5f, 20.5f});
    // One weak segment and one of magnitude 2, which are followed by 9 and the last one.
    CHECK(drawing.segments.size() == 1 + 1 + 9 + 1);
}

TEST_CASE(
    "furrow trace: where the field is zero a furrow is one point of the band"
    * technique("wrinkle.furrow.trace")) {
    const FurrowMap map = test::make_flat_furrow_map({20, 20}, {0, 0});
    const Traced drawing = trace_half(map, {}, {10.5f, 10.5f});
    CHECK(drawing.segments.empty());
    CHECK(drawing.cells[10 * 20 + 10] == kFurrowBand);
    CHECK(std::count(drawing.cells.begin(), drawing.cells.end(), 0u) == 399);
}

TEST_CASE(
    "furrow trace: segments turn at random by up to the angle, evenly to both sides"
    * technique("wrinkle.furrow.trace")) {
    const FurrowMap map = test::make_flat_furrow_map({400, 400}, {1, 0});
    FurrowStyle style;
    double sum = 0;
    double square_sum = 0;
    double most = 0;
    double count = 0;
    for (std::uint32_t furrow = 1; furrow <= 200; ++furrow) {
        Traced drawing = {make_furrow_drawing(map)};
        trace_half_furrow(
            map, cover_furrow_map(map), style, 0, furrow, {200, 200}, furrow % 2 == 0, drawing,
            &drawing.segments);
        for (const FurrowSegment& s : drawing.segments) {
            const Vec2 d = (s.to - s.from) * (s.backward ? -1.0f : 1.0f);
            const double turn = std::atan2(static_cast<double>(d.y), static_cast<double>(d.x));
            sum += turn;
            square_sum += turn * turn;
            most = std::max(most, std::abs(turn));
            count += 1;
        }
    }
    CHECK(count == 200 * 21);
    CHECK(most <= 0.6 + 1e-4);
    CHECK(most > 0.59);
    CHECK(std::abs(sum / count) < 3 * 0.6 / std::sqrt(3.0) / std::sqrt(count));
    CHECK(std::sqrt(square_sum / count) == test::near(0.6 / std::sqrt(3.0)).epsilon(0.02));
    style.literal_turn = true;
    const Traced literal = trace_half(map, style, {200, 200});
    const Vec2 d = literal.segments[0].to - literal.segments[0].from;
    CHECK(std::atan2(d.y, d.x) == test::near(0.6));
}

TEST_CASE(
    "furrow trace: furrows of one field never cross, they end on each other"
    * technique("wrinkle.furrow.topography")) {
    Random random(3, 0, 0, 0);
    for (int run = 0; run < 4; ++run) {
        const float angle = random.uniform(0, 2 * kPi);
        const float x = random.uniform(0.4f, 2.0f);
        const FurrowMap map =
            test::make_flat_furrow_map({160, 160}, x * Vec2(std::cos(angle), std::sin(angle)));
        FurrowStyle style;
        style.seed = run;
        const Traced drawing = trace_all(map, style);
        // A pixel belongs to the first furrow that crosses it; no other axis may pass through it.
        int crossings = 0;
        int ends = 0;
        for (const FurrowSegment& s : drawing.segments) {
            const float length = glm::distance(s.from, s.to);
            for (float at = 0; at < length - 0.01f; at += 0.05f) {
                const Vec2 p = s.from + (s.to - s.from) * (at / length);
                const auto cell =
                    static_cast<std::size_t>(p.y) * 160 + static_cast<std::size_t>(p.x);
                const std::uint32_t owner = drawing.cells[cell] & ~kFurrowBand;
                crossings += owner != s.furrow ? 1 : 0;
            }
            ends += s.met ? 1 : 0;
        }
        CHECK(crossings == 0);
        CHECK(ends > 50);
    }
}

TEST_CASE(
    "furrow trace: afterwards the whole surface is in a band, and nothing is drawn beyond it"
    * technique("wrinkle.furrow.heightfield")) {
    FurrowMap map = test::make_flat_furrow_map({120, 120}, {0.8f, 0.3f});
    map.triangles.resize(1);  // the upper right half
    const auto cover = cover_furrow_map(map);
    const FurrowDrawing drawing = trace_furrows(map, cover, {}, 0);
    std::size_t covered = 0;
    for (std::size_t i = 0; i < cover.size(); ++i) {
        if (cover[i] >= 0) {
            ++covered;
            CHECK((drawing.cells[i] & kFurrowBand) != 0);
        } else {
            CHECK(drawing.height[i] == 1.0f);
        }
    }
    CHECK(covered == 120 * 121 / 2);
}

TEST_CASE(
    "furrow trace: no furrow starts within half the band of an earlier one"
    * technique("wrinkle.furrow.heightfield")) {
    const FurrowMap map = test::make_flat_furrow_map({200, 200}, {1.1f, -0.4f});
    const Traced drawing = trace_all(map, {});
    std::map<std::uint32_t, std::size_t> first;  // segment of each furrow
    for (std::size_t i = 0; i < drawing.segments.size(); ++i) {
        first.try_emplace(drawing.segments[i].furrow, i);
    }
    std::size_t early = 0;
    for (const auto& start : first) {
        for (std::size_t i = 0; i < start.second; ++i) {
            const FurrowSegment& s = drawing.segments[i];
            early +=
                distance_to_segment(drawing.segments[start.second].from, s) < 0.5f * s.band - 1e-3f;
        }
    }
    CHECK(early == 0);
    CHECK(first.size() > 100);
}

TEST_CASE(
    "furrow trace: stronger fields have fewer, sparser furrows"
    * technique("wrinkle.furrow.heightfield")) {
    std::size_t before = SIZE_MAX;
    for (const float x : {0.5f, 1.0f, 1.5f, 2.0f}) {
        const std::size_t furrows =
            count_furrows(trace_all(test::make_flat_furrow_map({256, 256}, {x, 0}), {}));
        CHECK(furrows < before);
        before = furrows;
    }
}

TEST_CASE(
    "furrow trace: the same seed gives the same furrows, another seed others"
    * technique("wrinkle.furrow.trace")) {
    const FurrowMap map = test::make_flat_furrow_map({100, 100}, {1, 0.5f});
    FurrowStyle style;
    const Traced once = trace_all(map, style);
    CHECK(trace_all(map, style).cells == once.cells);
    CHECK(trace_all(map, style).height == once.height);
    style.seed = 2;
    CHECK(trace_all(map, style).cells != once.cells);
}

TEST_CASE(
    "furrow trace: furrows cross the border of an image that repeats"
    * technique("wrinkle.furrow.trace")) {
    FurrowMap map = test::make_flat_furrow_map({64, 48}, {0.995f, 0.0995f});
    map.wrap_s = true;
    const Traced drawing = trace_half(map, make_straight_style(), {50.5f, 20.5f});
    CHECK(drawing.segments.size() == 21);
    CHECK(drawing.cells[21 * 64 + 0] != 0);  // beyond the right border
    map.wrap_s = false;
    CHECK(trace_half(map, make_straight_style(), {50.5f, 20.5f}).segments.size() == 3);
}

TEST_CASE(
    "furrow trace: a wide furrow owns the pixels that it covers"
    * technique("wrinkle.furrow.trace")) {
    const FurrowMap map = test::make_flat_furrow_map({200, 40}, {2, 0});
    FurrowStyle style = make_straight_style();
    style.scale = 2;  // 4 px wide
    const Traced drawing = trace_half(map, style, {20.5f, 20.3f});
    for (std::size_t row = 0; row < 40; ++row) {
        const std::uint32_t owner = drawing.cells[row * 200 + 60] & ~kFurrowBand;
        CHECK(owner == (row >= 18 && row <= 21 ? 1u : 0u));
    }
}

TEST_CASE(
    "furrow trace: a line of width w covers w of each pixel across it"
    * technique("wrinkle.furrow.trace")) {
    for (const float x : {0.3f, 0.7f, 1.0f, 1.6f}) {
        const FurrowMap map = test::make_flat_furrow_map({200, 40}, {x, 0});
        for (const float y : {20.5f, 20.3f, 20.0f}) {
            const Traced drawing = trace_half(map, make_straight_style(), {20.5f, y});
            const float depth = furrow_shape({}, x).depth;
            double sum = 0;
            for (std::size_t row = 0; row < 40; ++row) {
                sum += (1.0 - static_cast<double>(drawing.height[row * 200 + 60]))
                       / static_cast<double>(depth);
            }
            CHECK(sum == test::near(static_cast<double>(x)).epsilon(1e-3));
        }
    }
}

TEST_CASE(
    "furrow topography: furrows of both fields cross and mostly enclose four-sided skin"
    * technique("wrinkle.furrow.topography")) {
    constexpr int kSide = 240;
    const FurrowMap map = test::make_flat_furrow_map({kSide, kSide}, {1, 0.2f}, {-0.2f, 1});
    FurrowStyle style;
    style.functions.angle = {0.1f, 0};
    const Traced drawings[] = {trace_all(map, style, 0), trace_all(map, style, 1)};
    const auto owner = [&](int field, int pixel) {
        return drawings[field].cells[static_cast<std::size_t>(pixel)] & ~kFurrowBand;
    };
    int crossings = 0;
    for (int pixel = 0; pixel < kSide * kSide; ++pixel) {
        crossings += owner(0, pixel) != 0 && owner(1, pixel) != 0 ? 1 : 0;
    }
    CHECK(crossings > 500);
    // The sides of a patch of skin are the furrows around it. Patches at the border are left out.
    std::vector<bool> visited(kSide * kSide);
    std::map<std::size_t, int> patches;  // by number of sides
    for (int start = 0; start < kSide * kSide; ++start) {
        if (visited[start] || owner(0, start) != 0 || owner(1, start) != 0) {
            continue;
        }
        std::vector<int> open = {start};
        std::map<std::pair<int, std::uint32_t>, int> contacts;  // pixels at each furrow
        bool inside = true;
        std::size_t area = 0;
        visited[start] = true;
        while (!open.empty()) {
            const int pixel = open.back();
            open.pop_back();
            ++area;
            const int x = pixel % kSide;
            const int y = pixel / kSide;
            inside = inside && x > 0 && y > 0 && x < kSide - 1 && y < kSide - 1;
            for (const int next : {pixel - 1, pixel + 1, pixel - kSide, pixel + kSide}) {
                if (!inside || visited[next]) {
                    continue;
                }
                const bool free = owner(0, next) == 0 && owner(1, next) == 0;
                visited[next] = free;
                if (free) {
                    open.push_back(next);
                }
                for (const int field : {0, 1}) {
                    if (owner(field, next) != 0) {
                        ++contacts[{field, owner(field, next)}];
                    }
                }
            }
        }
        if (inside && area >= 6) {
            const auto sides = std::count_if(
                contacts.begin(), contacts.end(), [](const auto& c) { return c.second >= 2; });
            ++patches[static_cast<std::size_t>(sides)];
        }
    }
    int all = 0;
    for (const auto& sides : patches) {
        all += sides.second;
    }
    REQUIRE(all > 300);
    CHECK(patches[4] > 0.85 * all);
}

}  // namespace limn::furrow_trace_test
