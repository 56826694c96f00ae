#include "ecs/components/beam.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "ecs/components/trail.h"
#include "render/particles/ribbon_list.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace limn::test::ribbon_test {
namespace {

const std::string kRibbonCode =
    "#include \"lib/ribbon.glsl\"\n"
    "// A direction for each number.\n"
    "vec3 direction(float n) {\n"
    "    float z = fract(n * 0.618034) * 2.0 - 1.0;\n"
    "    float angle = fract(n * 0.754878) * 6.2831853;\n"
    "    return vec3(sqrt(1.0 - z * z) * vec2(cos(angle), sin(angle)), z);\n"
    "}\n";

std::vector<Vec4> numbers(int count) {
    std::vector<Vec4> list;
    for (int i = 0; i < count; ++i) {
        const auto n = static_cast<float>(i);
        list.emplace_back(n, std::fmod(n * 0.7548f, 1.0f), std::fmod(n * 0.5698f, 1.0f), 0);
    }
    return list;
}

/// A strand along x that passed the origin first and then left `count` points, a spacing of 0.25 m
/// apart, at 1 m/s.
TrailState straight_strand(int count) {
    TrailState state;
    state.capacity = static_cast<std::uint32_t>(count);
    TrailStrand strand;
    for (int i = 0; i < count; ++i) {
        const float x = 0.25f * static_cast<float>(i);
        state.points.push_back({{x, 0, 0}, 0.25f * static_cast<float>(count - 1 - i) + 0.05f, {}});
    }
    strand.count = strand.number = state.capacity;
    strand.head.position = {state.points.back().position.x + 0.05f, 0, 0};
    strand.previous.position = strand.head.position - Vec3(0.02f, 0, 0);
    state.strands.push_back(strand);
    return state;
}

RibbonList ribbons_of(const Trail& trail, const TrailState& state, float back = 0) {
    RibbonList list;
    append_trail(trail, state, back, 0.02f, list);
    return list;
}

/// The lit, unsoftened look of a line of light.
ParticleLook line(float size, float opacity = 1, float cover = 0) {
    ParticleLook look;
    look.size = size;
    look.colors = {{.at = 0, .color = {1, 1, 1}, .opacity = opacity}};
    look.emission = 1;
    look.lit = 0;
    look.cover = cover;
    look.softness = 0;
    return look;
}

struct RibbonScene : Scene {
    RibbonScene() { world.insert_resource(FrameTime{.step = 0.02f}); }

    /// A trail through `positions`, from the oldest on.
    void
    draw_trail(const std::vector<Vec3>& positions, const ParticleLook& look, Trail trail = {}) {
        TrailState state;
        state.capacity = static_cast<std::uint32_t>(positions.size());
        TrailStrand strand;
        for (const Vec3& position : positions) {
            state.points.push_back({position, 0.02f, trail.span});
        }
        strand.count = strand.number = state.capacity;
        strand.head = strand.previous = {positions.back(), 0, trail.span};
        state.strands.push_back(strand);
        trail.length = trail.life = 1000;
        world.create(trail, state, look);
    }
    gpu::FloatImage image() { return radiance(look({0, 0, 1}, {0, 0, 0}, 65, 65)); }
};

}  // namespace

TEST_CASE_FIXTURE(RenderTest, "ribbon: a straight one has its width from any view") {
    const std::vector<Vec4> edges = evaluate_shader(
        kRibbonCode,
        "vec3 along = direction(x.x); vec3 to_camera = direction(x.x + 500.5);"
        "vec3 edge = ribbon_edge(-2.0 * x.y * along, vec3(0.0), x.z * along, to_camera, vec3(9.0), "
        "0.3);"
        "y = vec4(length(edge), dot(edge, to_camera), dot(edge, along), 0.0);",
        numbers(500));
    for (std::size_t i = 1; i < edges.size(); ++i) {
        CHECK(edges[i].x == near(0.3).epsilon(1e-4));
        CHECK(edges[i].y == near(0).scale(0.3).epsilon(1e-4));
        CHECK(edges[i].z == near(0).scale(0.3).epsilon(1e-4));
    }
}

TEST_CASE_FIXTURE(RenderTest, "ribbon: no edge is farther than two half widths away, at any turn") {
    const std::vector<Vec4> edges = evaluate_shader(
        kRibbonCode,
        "vec3 came = direction(x.x); vec3 goes = mix(direction(x.x + 777.0), -came, step(0.5, "
        "x.y));"
        "goes = x.z < 0.1 ? vec3(0.0) : goes; came = x.z < 0.05 ? vec3(0.0) : came;"
        "vec3 to_camera = x.z > 0.9 ? direction(x.x) : direction(x.x + 500.5);"
        "float size = exp2(8.0 * x.y - 6.0);"
        "vec3 right = normalize(cross(to_camera, vec3(0.3, 0.5, 0.7)));"
        "vec3 edge = ribbon_edge(-size * came, vec3(0.0), size * goes, to_camera, right, 0.3);"
        "vec3 join = 0.3 * ribbon_join(-size * came, vec3(0.0), size * goes, int(x.x) & 3, "
        "to_camera, right).xyz;"
        "y = vec4(length(edge), dot(edge, to_camera), length(join), dot(join, to_camera));",
        numbers(4000));
    for (const Vec4& edge : edges) {
        CHECK(edge.x < 0.6001f);
        CHECK(edge.x > 0.2999f);
        CHECK(std::abs(edge.y) < 1e-4f);
        CHECK(edge.z < 0.3001f);  // false for NaN, too
        CHECK(std::abs(edge.w) < 1e-4f);
    }
}

TEST_CASE_FIXTURE(RenderTest, "ribbon: a miter is as long as two half widths meet, on both edges") {
    // From -x, then turning left by each angle.
    const std::vector<Vec4> edges = evaluate_shader(
        kRibbonCode,
        "vec3 edge = ribbon_edge(vec3(-5, 0, 0), vec3(0.0), 5.0 * vec3(cos(x.x), sin(x.x), 0), "
        "vec3(0, 0, 1), vec3(9), 0.3);"
        "y = vec4(dot(edge, vec3(0, 1, 0)), dot(edge, vec3(-sin(x.x), cos(x.x), 0)), 0.0, 0.0);",
        {{-1.5f, 0, 0, 0}, {-0.4f, 0, 0, 0}, {0.2f, 0, 0, 0}, {1, 0, 0, 0}, {2, 0, 0, 0}});
    for (const Vec4& edge : edges) {
        CHECK(edge.x == near(0.3).epsilon(1e-4));
        CHECK(edge.y == near(0.3).epsilon(1e-4));
    }
}

TEST_CASE_FIXTURE(RenderTest, "ribbon: a join's corners are those of the pieces, on the outside") {
    const std::vector<Vec4> corners = evaluate_shader(
        kRibbonCode,
        "y = ribbon_join(vec3(-1, 0, 0), vec3(0.0), vec3(0, x.y, 0), int(x.x), vec3(0, 0, 1), "
        "vec3(9));",
        {{0, 1, 0, 0}, {1, 1, 0, 0}, {2, 1, 0, 0}, {3, 1, 0, 0}, {0, -1, 0, 0}, {3, -1, 0, 0}});
    const float half = std::sqrt(0.5f);
    const std::vector<Vec4> want = {{0, -1, 0, -1}, {0, 0, 0, 0}, {half, -half, 0, -1},
                                    {1, 0, 0, -1},  {0, 1, 0, 1}, {1, 0, 0, 1}};
    for (std::size_t i = 0; i < want.size(); ++i) {
        CAPTURE(i);
        CHECK(glm::distance(corners[i], want[i]) < 1e-5f);
    }
}

TEST_CASE(
    "ribbon: a trail ends exactly at its length, or its life, whichever comes first"
    * technique("engine.trail")) {
    const TrailState state = straight_strand(41);
    for (const float length : {0.3f, 1.0f, 4.13f}) {
        for (const float life : {0.5f, 2.2f, 100.0f}) {
            CAPTURE(length);
            CAPTURE(life);
            const RibbonList list =
                ribbons_of({.spacing = 0.25f, .length = length, .life = life}, state);
            const RibbonPoint& head = list.points[1];
            const RibbonPoint& tail = list.points[list.points.size() - 2];
            CHECK(head.curve_at == 0);
            CHECK(tail.curve_at == near(1).epsilon(1e-4));
            CHECK(head.u == 0);
            CHECK(tail.u == near(1));
            CHECK(
                head.position.x - tail.position.x
                == near(std::min({length, life, 10.05f})).epsilon(1e-4));
        }
    }
}

TEST_CASE("ribbon: texture stays with the points of a trail while it moves on and shortens") {
    const Trail longer = {.spacing = 0.25f, .length = 8, .life = 100, .tile = 1.7f};
    Trail shorter = longer;
    shorter.length = 3;
    const RibbonList all = ribbons_of(longer, straight_strand(41));
    const auto texture_at = [](const RibbonList& list, float x) {
        for (const RibbonPoint& point : list.points) {
            if (std::abs(point.position.x - x) < 1e-4f) {
                return static_cast<double>(point.u - std::floor(point.u));
            }
        }
        return -1.0;
    };
    for (const float x : {7.5f, 8.0f, 9.75f}) {
        const double u = texture_at(all, x);
        CHECK(u == near(1 - std::fmod(static_cast<double>(x) / 1.7, 1.0)).epsilon(1e-3));
        CHECK(texture_at(ribbons_of(shorter, straight_strand(41)), x) == near(u).epsilon(1e-4));
        CHECK(texture_at(ribbons_of(longer, straight_strand(44)), x) == near(u).epsilon(1e-4));
    }
    for (std::size_t i = 2; i + 2 < all.points.size(); ++i) {
        CHECK(all.points[i + 1].u >= all.points[i].u);
    }
}

TEST_CASE(
    "ribbon: between steps the head is on its path, and points it has not reached are absent") {
    const Trail trail = {.spacing = 0.25f, .length = 2, .life = 100};
    const TrailState state = straight_strand(41);
    const RibbonList list = ribbons_of(trail, state, 0.01f);
    CHECK(list.points[1].position.x == near(10.04));
    TrailState due = state;
    due.points.back().age = 0.005f;  // was left within this step
    CHECK(ribbons_of(trail, due, 0.01f).points[3].position.x == near(9.75));
}

TEST_CASE("ribbon: through particles it goes from the youngest to the oldest, and breaks at gaps") {
    ParticlePool pool;
    for (int i = 0; i < 6; ++i) {
        const auto n = static_cast<float>(i);
        pool.x.push_back(i < 2 ? 90 - n : 5 - n);
        for (auto* column : {&pool.y, &pool.z, &pool.vx, &pool.vy, &pool.vz}) {
            column->push_back(0);
        }
        pool.age.push_back(0.5f * (5 - n));
        pool.life.push_back(5);
    }
    pool.clock.born = 106;
    RibbonList list;
    const Vec3 head(-0.5f, 0, 0);
    const Trail trail = {.path = TrailPath::Births, .spacing = 1, .jump = 3, .tile = 4};
    append_births(trail, pool, 0, &head, list);
    std::vector<float> line;
    std::vector<float> u;
    for (std::size_t i = 0; i < list.segments.size(); ++i) {
        line.push_back(list.points[list.segments[i] + 1].position.x);
        u.push_back(list.points[list.segments[i] + 1].u);
    }
    // Each ribbon: a cap, its segments, a cap.
    CHECK(line == std::vector<float>{-0.5f, -0.5f, 0, 1, 2, 3, 89, 89, 90});
    CHECK(u[2] == near(-105 / 4.0));
    CHECK(u[5] == near(-102 / 4.0));
    CHECK(list.points[list.segments[3] + 1].curve_at == near(0.1));
}

TEST_CASE("ribbon: a beam reaches exactly from end to end, between steps as well") {
    const BeamState state = {
        .shown = true,
        .start = {0, 0, 0},
        .end = {8, 0, 0},
        .previous_start = {0, 2, 0},
        .previous_end = {8, 0, 4}};
    for (const float alpha : {0.0f, 0.25f, 1.0f}) {
        RibbonList list;
        append_beam({.jag = 0.3f, .detail = 5}, state, {}, alpha, 0, list);
        CHECK(list.points[1].position == Vec3(0, 2 - 2 * alpha, 0));
        CHECK(list.points[1].curve_at == 0);
        const RibbonPoint& end = list.points[list.points.size() - 2];
        CHECK(end.position == Vec3(8, 0, 4 - 4 * alpha));
        CHECK(end.curve_at == 1);
        CHECK(end.u == near(1));
    }
    RibbonList none;
    append_beam({}, {}, {}, 1, 0, none);
    CHECK(none.points.empty());
}

TEST_CASE("ribbon: branches leave their beam at one of its points, and end as it does") {
    const BeamState state = {.shown = true, .end = {8, 0, 0}, .previous_end = {8, 0, 0}};
    RibbonList list;
    append_beam({.jag = 0.2f, .detail = 6, .branches = 9}, state, {}, 1, 0, list);
    const std::vector<RibbonPoint>& points = list.points;
    int branches = 0;
    for (const std::uint32_t before : list.segments) {
        const bool is_cap = points[before].position == points[before + 3].position;
        const RibbonPoint& begin = points[before + 1];
        if (is_cap && begin.curve_at > 0 && begin.curve_at < 1) {
            ++branches;
            bool found = false;
            for (const Vec3& point : list.bolt) {
                found = found || point == begin.position;
            }
            CHECK(found);
        }
    }
    CHECK(branches == 9);
    CHECK(points[points.size() - 2].curve_at == 1);
}

TEST_CASE("ribbon: points that coincide or are not finite leave no segment") {
    RibbonList list;
    const float nan = std::nanf("");
    for (const Vec3& position : {Vec3(1), Vec3(1), Vec3(nan), Vec3(2), Vec3(2.00001f)}) {
        list.strip.push_back({position, 0, Vec3(0), 0});
    }
    list.add_strip();
    CHECK(list.segments.size() == 3);
    list.strip.push_back({Vec3(1), 0, Vec3(0), 0});
    list.add_strip();
    CHECK(list.segments.size() == 3);
    CHECK(list.strip.empty());
}

TEST_CASE_FIXTURE(
    RibbonScene, "ribbon: in the image it has its width and reaches from end to end") {
    draw_trail({{-0.3f, 0, 0}, {-0.2f, 0, 0}, {0.3f, 0, 0}}, line(0.4f));
    const gpu::FloatImage found = image();
    int high = 0;
    int wide = 0;
    for (int i = 0; i < 65; ++i) {
        high += found.at(32, i, 0) > 1e-4f ? 1 : 0;
        wide += found.at(i, 32, 0) > 1e-4f ? 1 : 0;
    }
    CHECK(std::abs(high - 0.4 * 32.5) <= 2);
    CHECK(std::abs(wide - 1.0 * 32.5) <= 2);  // with two round ends
    CHECK(found.at(32, 32, 0) == near(1).epsilon(0.02));
    CHECK(found.at(22, 32, 0) == near(found.at(42, 32, 0)).epsilon(1e-3));
}

TEST_CASE_FIXTURE(
    RibbonScene, "ribbon: pieces meet without a seam, and bends glow no more than the rest"
                     * technique("engine.trail")) {
    std::vector<Vec3> positions;
    for (int i = 0; i <= 40; ++i) {
        const float angle = kPi * static_cast<float>(i) / 40;
        positions.emplace_back(-0.6f * std::cos(angle), 0.6f * std::sin(angle) - 0.3f, 0);
    }
    draw_trail(positions, line(0.2f));
    const gpu::FloatImage found = image();
    float most = 0;
    for (const float value : found.pixels) {
        most = std::max(most, value);
    }
    CHECK(most <= 1.001f);
    for (int i = 2; i <= 38; ++i) {
        const Vec3& p = positions[static_cast<std::size_t>(i)];
        const int x = static_cast<int>(32.5f + 32.5f * p.x);
        const int y = static_cast<int>(32.5f - 32.5f * p.y);
        CHECK(std::max(found.at(x, y, 0), found.at(x, 64 - y, 0)) > 0.8f);
    }
}

TEST_CASE_FIXTURE(RibbonScene, "ribbon: it is blended among other particles by its distance") {
    const auto center_pixel = [&](float depth) {
        world.clear();
        draw_trail({{-0.7f, 0, depth}, {0.7f, 0, depth}}, line(0.4f, 1, 1));
        ParticlePool pool;
        for (auto* column : {&pool.x, &pool.y, &pool.z, &pool.vx, &pool.vy, &pool.vz}) {
            column->push_back(0);
        }
        pool.age.push_back(0.5f);
        pool.life.push_back(1);
        pool.look.push_back(7);
        ParticleLook green = line(0.5f, 1, 1);
        green.colors[0].color = {0, 1, 0};
        world.create(ParticleEmitter{}, green, pool);
        return rgb_at(image(), 32, 32);
    };
    CHECK(center_pixel(0.2f).x > 0.95f);
    CHECK(center_pixel(-0.2f).x < 0.05f);
    CHECK(center_pixel(-0.2f).y > 0.9f);
}

TEST_CASE_FIXTURE(RibbonScene, "ribbon: one thinner than a pixel is fainter, not dotted") {
    draw_trail({{-0.7f, -0.13f, 0}, {0.7f, 0.21f, 0}}, line(0.004f));
    const gpu::FloatImage found = image();
    std::vector<float> sums;
    for (int x = 15; x < 50; ++x) {
        float sum = 0;
        for (int y = 0; y < 65; ++y) {
            sum += found.at(x, y, 0);
        }
        sums.push_back(sum);
    }
    for (const float sum : sums) {
        CHECK(sum > 0.03f);
        CHECK(sum < 0.2f);
    }
}

TEST_CASE_FIXTURE(RibbonScene, "ribbon: a blade's is spanned as the blade was, whatever the view") {
    Trail trail;
    trail.span = {0, 0.8f, 0};
    draw_trail({{-0.5f, -0.4f, 0}, {0.5f, -0.4f, 0}}, line(9), trail);
    const gpu::FloatImage found = image();
    int high = 0;
    for (int i = 0; i < 65; ++i) {
        high += found.at(32, i, 0) > 1e-4f ? 1 : 0;
    }
    CHECK(std::abs(high - 0.8 * 32.5) <= 2);
    CHECK(found.at(32, 32, 0) > 0.95f);  // at the center
    const gpu::FloatImage above = radiance(look({0, 1, 0.001f}, {0, 0, 0}, 65, 65));
    high = 0;
    for (int i = 0; i < 65; ++i) {
        high += above.at(32, i, 0) > 1e-4f ? 1 : 0;
    }
    CHECK(high <= 1);  // edge-on
}

TEST_CASE_FIXTURE(
    RibbonScene, "ribbon: a beam is drawn between its ends, at the time of the frame") {
    const BeamState state = {
        .shown = true,
        .start = {-0.5f, 0, 0},
        .end = {0.5f, 0, 0},
        .previous_start = {-0.5f, 0, 0},
        .previous_end = {0.5f, 0, 0}};
    const Entity entity = world.create(Beam{}, state, line(0.2f));
    CHECK(image().at(32, 32, 0) == near(1).epsilon(1e-3));
    CHECK(image().at(2, 32, 0) == 0);
    world.get<Beam>(entity) = {.jag = 0.5f, .rate = 10};
    const gpu::FloatImage first = image();
    CHECK(largest_difference(first, image()) == 0);
    world.resource<FrameTime>().time = 0.5;
    CHECK(largest_difference(first, image()) > 0.3f);
}

}  // namespace limn::test::ribbon_test
