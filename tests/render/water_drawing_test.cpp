#include "ecs/base/optics.h"
#include "ecs/components/caustics.h"
#include "ecs/components/ocean.h"
#include "ecs/components/time.h"
#include "ecs/components/water.h"
#include "ecs/components/water_ripples.h"
#include "ecs/components/water_waves.h"
#include "render/gpu/readback.h"
#include "render/graph/frame_graph.h"
#include "render/render_frame.h"
#include "render/shaders/water_gpu.h"
#include "render/water/foam_pattern.h"
#include "render/water/ripple_atlas.h"
#include "systems/water/ocean_system.h"
#include "systems/water/water_query.h"
#include "systems/water/water_ripple_field.h"
#include "systems/water/water_wave_table.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

// Water at moments between steps, its ripples on the GPU, and light that it gives back.

namespace limn::test::water_drawing_test {
namespace {

constexpr float kStep = 1.0f / 60;
constexpr double kNow = 2.5;

class Lake : public Scene {
  public:
    Lake() {
        world.insert_resource(FrameTime{.step = kStep, .time = kNow});
        world.insert_resource(Exposure{});
    }
    Entity pour(const Water& water, const Affine& pose = at({0, 0, 0})) {
        return world.create(water, WorldTransform{pose});
    }
    void surround(const Vec3& color) {
        world.insert_resource(Environment{
            .sky = SkyKind::Uniform,
            .zenith = color,
            .horizon = color,
            .ground = color,
            .visible = true});
    }
    static Vec3 eye_of(const RenderView& view) {
        const Affine& pose = view.world_from_camera;
        return {pose.row[0].w, pose.row[1].w, pose.row[2].w};
    }
    /// One meter along the axis of the view.
    static Vec3 ray_through(const RenderView& view, int x, int y) {
        const Vec2 size(view.width, view.height);
        const Vec2 uv = (Vec2(x, y) + 0.5f) / size;
        const Vec2 ndc = {2 * uv.x - 1, 1 - 2 * uv.y};
        const Affine& pose = view.world_from_camera;
        const auto column = [&](int c) {
            return Vec3(pose.row[0][c], pose.row[1][c], pose.row[2][c]);
        };
        return ndc.x * view.tangent.x * column(0) + ndc.y * view.tangent.y * column(1) - column(2);
    }
};

WaterWaves all_waves() {
    return {
        .waves =
            {{.amplitude = 0.2f, .length = 9, .direction = 1, .sharpness = 1},
             {.amplitude = 0.1f, .length = 5, .direction = -1, .lean = 0.5f}},
        .radial =
            {{.amplitude = 0.15f, .length = 6, .fade_radius = 2}, {.length = 4, .inward = true}},
        .packets = {
            {.center = {1, -2}, .age = 1.5f, .amplitude = 0.1f, .length = 4, .waves = 1},
            {.center = {-2, 0},
             .age = 1.2f,
             .amplitude = 0.1f,
             .length = 5,
             .waves = 1,
             .smooth = false}}};
}

/// As it was `ago` seconds before the end of the last step.
WaveTable table_at(const Water& water, double ago) {
    WaterWaves waves = all_waves();
    for (WavePacket& packet : waves.packets) {
        packet.age -= static_cast<float>(ago);
        packet.decay = 0;
    }
    WaveTable table;
    fill_wave_table(water, waves, kNow - ago, table);
    return table;
}

/// Uneven ripples that move up and down.
RippleState make_rough(const Water& water, float cell) {
    RippleState state = make_ripples(water, {.cell = cell}, kStep);
    for (int z = 0; z < state.cells.y; ++z) {
        for (int x = 0; x < state.cells.x; ++x) {
            const Vec2 p(x, z);
            const std::size_t pose = state.at(x, z);
            state.height[pose] = 0.1f * std::sin(0.7f * p.x) * std::cos(0.4f * p.y);
            state.previous[pose] = state.height[pose] - 0.01f * std::cos(0.5f * p.x + 0.3f * p.y);
        }
    }
    return state;
}

}  // namespace

TEST_CASE_FIXTURE(Lake, "ripple atlas: its texels match the query, up to the edge of each field") {
    const RippleState states[] = {
        make_rough({.size = {3, 2}}, 0.1f), make_rough({.size = {1, 4}}, 0.1f),
        make_rough({.size = {2, 2}}, 0.25f), make_rough({.size = {5, 1}}, 0.1f)};
    const RippleState none = make_ripples({}, {}, kStep);
    const RippleState* const all[] = {&states[0], nullptr,    &states[1],
                                      &none,      &states[2], &states[3]};
    RippleAtlas atlas;
    atlas.update(all, 4096);
    const gpu::FloatImage image = gpu::read_floats(atlas.texture());
    REQUIRE(atlas.tiles().size() == 6);
    for (std::size_t i = 0; i < 6; ++i) {
        const RippleTile& tile = atlas.tiles()[i];
        CHECK(tile.fits == (all[i] != nullptr && all[i] != &none));
        if (!tile.fits) {
            continue;
        }
        const RippleState& state = *all[i];
        for (int z = -1; z <= state.cells.y; ++z) {
            for (int x = -1; x <= state.cells.x; ++x) {
                // The texel around it repeats the outermost.
                const IVec2 cell = glm::clamp(IVec2(x, z), IVec2(0), state.cells - 1);
                const Vec2 center = state.cell * (Vec2(cell) + 0.5f - 0.5f * Vec2(state.cells));
                const RipplePoint point = sample_ripples(state, center);
                const int row = image.height - 1 - (tile.corner.y + z);
                const auto texel = [&](int c) { return image.at(tile.corner.x + x, row, c); };
                CHECK(std::abs(texel(0) - point.height) < 1e-6f);
                CHECK(std::abs(texel(1) - point.velocity) < 1e-4f);
                CHECK(std::abs(texel(2) - point.slope.x) < 1e-5f);
                CHECK(std::abs(texel(3) - point.slope.y) < 1e-5f);
            }
        }
    }
}

TEST_CASE_FIXTURE(Lake, "water: between steps its waves are interpolated in time") {
    const Water water = {.size = {40, 40}, .absorption = Vec3(1)};
    const Entity lake = pour(water);
    world.add(lake, table_at(water, 0));
    RenderView view = look({2, 4, 5}, {0, 0.3f, 0}, 96, 64);
    for (const float alpha : {1.0f, 0.5f, 0.0f}) {
        view.alpha = alpha;
        // Steps of a 60th are short: waves of these lengths would be less than a pixel off.
        world.resource<FrameTime>().step = 0.5f;
        const WaveTable then = table_at(water, static_cast<double>(0.5f * (1 - alpha)));
        WaterSurface surface;
        surface.water = water;
        surface.waves = &then;
        const gpu::FloatImage depth = aov(view, "depth");
        double squares = 0;
        int count = 0;
        for (int y = 2; y < view.height; y += 5) {
            for (int x = 2; x < view.width; x += 5) {
                const float d = depth.at(x, y, 0);
                if (d < 30) {
                    const Vec3 p = ray_through(view, x, y) * d + eye_of(view);
                    const WaterPoint expected = sample_water(surface, {p.x, p.z});
                    const float pixel = d * 2 / 64;
                    squares += static_cast<double>(square((p.y - expected.position.y) / pixel));
                    ++count;
                }
            }
        }
        CAPTURE(alpha);
        CHECK(count > 100);
        CHECK(std::sqrt(squares / count) < 0.05);
    }
}

TEST_CASE_FIXTURE(Lake, "water: rings and ripples move as they did since the previous frame") {
    const Water water = {.size = {40, 40}};
    const float step = 0.2f;  // so long that much moves
    world.resource<FrameTime>().step = step;
    for (const bool ripples : {false, true}) {
        const Entity lake = pour(water);
        WaveTable now = table_at(water, 0);
        WaveTable before = table_at(water, static_cast<double>(step));
        RippleState state = make_ripples(water, {.cell = 0.5f}, kStep);
        for (float& height : state.previous) {
            height -= 0.5f * kStep;  // it rises by half a meter a second
        }
        if (ripples) {
            world.add(lake, state);
        } else {
            now.lines.clear();
            before.lines.clear();
            world.add(lake, now);
        }
        const RenderView view = look({0, 3, 6}, {0, 0, 0}, 64, 48);
        const gpu::FloatImage moving = aov(view, "velocity");
        const gpu::FloatImage depth = aov(view, "depth");
        const auto pixel = [&](const Vec3& p) {
            const Vec4 clip = view.unjittered_from_world * Vec4(p, 1);
            return Vec2(0.5f + 0.5f * clip.x / clip.w, 0.5f - 0.5f * clip.y / clip.w)
                   * Vec2(view.width, view.height);
        };
        int tested = 0;
        float fastest = 0;
        for (int y = 22; y < 48; y += 4) {
            for (int x = 3; x < 64; x += 7) {
                const float d = depth.at(x, y, 0);
                if (d > 14) {
                    continue;
                }
                const Vec3 is = ray_through(view, x, y) * d + eye_of(view);
                const Vec2 rest = {is.x, is.z};
                const float rise = ripples ? 0.5f * step
                                           : evaluate_waves(now, rest).offset.y
                                                 - evaluate_waves(before, rest).offset.y;
                const Vec2 expected = pixel(is) - pixel(is - Vec3(0, rise, 0));
                CHECK(std::abs(moving.at(x, y, 0) - expected.x) < 0.05f);
                CHECK(std::abs(moving.at(x, y, 1) - expected.y) < 0.05f);
                fastest = std::max(fastest, std::abs(expected.y));
                ++tested;
            }
        }
        CHECK(tested > 20);
        CHECK(fastest > 0.4f);
        world.destroy(lake);
    }
}

TEST_CASE_FIXTURE(Lake, "water: leaning waves reflect by the slopes of the query") {
    // Black water under an even sky: what is mirrored is what the Fresnel equations say.
    surround({1, 1, 1});
    const Water water = {.absorption = Vec3(1000), .scattering = Vec3(0)};
    WaveTable table;
    fill_wave_table(
        water,
        {.waves = {{.amplitude = 0.12f, .length = 3, .direction = 0.8f, .lean = 0.8f}},
         .radial = {{.amplitude = 0.02f, .length = 2}}},
        kNow, table);
    world.add(pour(water), table);
    WaterSurface surface;
    surface.water = water;
    surface.waves = &table;
    const RenderView view = look({0, 2.5f, 2}, {0, 0, 0}, 96, 64);
    const gpu::FloatImage depth = aov(view, "depth");
    const gpu::FloatImage image = radiance(view);
    double squares = 0;
    int count = 0;
    for (int y = 20; y < 64; y += 3) {
        for (int x = 2; x < 96; x += 3) {
            const Vec3 p = ray_through(view, x, y) * depth.at(x, y, 0) + eye_of(view);
            const WaterPoint point = sample_water(surface, {p.x, p.z});
            const Vec3 to_camera = glm::normalize(eye_of(view) - p);
            const float cosine = glm::dot(point.normal, to_camera);
            if (cosine > 0.3f) {
                const double expected = static_cast<double>(fresnel(cosine, 1.333f));
                const double off = static_cast<double>(image.at(x, y, 1)) / expected - 1;
                squares += off * off;
                ++count;
            }
        }
    }
    CHECK(count > 200);
    CHECK(std::sqrt(squares / count) < 0.05);  // slopes are those of the vertices around
}

TEST_CASE_FIXTURE(Lake, "water: between patches of two sizes there is no crack") {
    surround({0, 0, 0});
    place(
        add(make_square()),
        add(Material{.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}}),
        affine_from({0, -3, 0}, glm::angleAxis(radians(-90), Vec3(1, 0, 0)), Vec3(300)));
    const Water water = {.absorption = Vec3(100), .scattering = Vec3(0)};
    const Entity lake = pour(water);
    WaveTable table;
    fill_wave_table(
        water,
        {.groups =
             {{.count = 12,
               .length = {2, 30},
               .amplitude = {0.05f, 0.25f},
               .spread = 3,
               .seed = 5}}},
        kNow, table);
    world.add(lake, table);
    // The last one looks over patches that no wave moves.
    for (const Vec3& eye : {Vec3(0, 2.5f, 0), Vec3(13, 6, 5), Vec3(-250, 150, -100)}) {
        const gpu::FloatImage image = radiance(look(eye, eye + Vec3(1, -0.5f, 0.4f), 320, 200));
        int bright = 0;
        for (int y = 0; y < 200; ++y) {
            for (int x = 0; x < 320; ++x) {
                bright += image.at(x, y, 0) > 0.02f ? 1 : 0;
            }
        }
        CHECK(bright == 0);
    }
}

TEST_CASE_FIXTURE(Lake, "water: deep water reflects a third of its backscatter over extinction") {
    surround({1, 1, 1});
    const float cosine_one = fresnel(1.0f, 1.333f);
    for (const Vec3 scattering : {Vec3(0.2f, 0.1f, 0), Vec3(2, 1, 0)}) {
        const Entity lake = pour({.absorption = Vec3(3), .scattering = scattering});
        const gpu::FloatImage image = radiance(look({0, 2, 0}, {0, 0, -0.01f}, 33, 33));
        for (int c = 0; c < 3; ++c) {
            const float glow = 0.33f * 0.54f * scattering[c] / (3 + scattering[c]);
            const float expected = cosine_one + (1 - cosine_one) * glow;
            CHECK(image.at(16, 16, c) == test::near(expected).epsilon(0.03).scale(0));
        }
        world.destroy(lake);
    }
}

TEST_CASE_FIXTURE(Lake, "water: the sun glints at its reflection; below the horizon it does not") {
    pour({.absorption = Vec3(1), .scattering = Vec3(0)});
    const RenderView view = look({0, 2, 0}, {0, 0, -2}, 65, 65);
    const gpu::FloatImage dark = radiance(view);
    const auto sun_toward = [&](const Vec3& from) {
        const Entity sun = shine(DirectionalLight{.illuminance = 1}, look_at(from, Vec3(0)));
        const gpu::FloatImage lit = radiance(view);
        world.destroy(sun);
        return lit;
    };
    const gpu::FloatImage lit = sun_toward({0, 1, -1});
    IVec2 brightest(0);
    for (int y = 0; y < 65; ++y) {
        for (int x = 0; x < 65; ++x) {
            if (lit.at(x, y, 0) > lit.at(brightest.x, brightest.y, 0)) {
                brightest = {x, y};
            }
        }
    }
    CHECK(glm::distance(Vec2(brightest), Vec2(32, 32)) <= 1);
    CHECK(lit.at(32, 32, 0) > dark.at(32, 32, 0) + 0.5f);
    CHECK(largest_difference(sun_toward({0, -1, -1}), dark) == 0);
    CHECK(largest_difference(sun_toward({0.2f, -0.001f, -1}), dark) == 0);
}

TEST_CASE_FIXTURE(Lake, "caustics: a sun at or below the horizon causes none") {
    surround({0.1f, 0.1f, 0.1f});
    place(
        add(make_square()), add(Material{.shading = ShadingModel::Blinn}),
        affine_from({0, -1.5f, 0}, glm::angleAxis(radians(-90), Vec3(1, 0, 0)), Vec3(4)));
    const Entity pool = pour({.size = {8, 8}, .depth = 1.5f});
    world.add(pool, table_at({.size = {8, 8}, .depth = 1.5f}, 0));
    const RenderView view = look({0, -0.3f, 0}, {0.5f, -1.5f, 0}, 64, 64);
    for (const Vec3 from :
         {Vec3(1, -0.5f, 0), Vec3(0, -1, 0.01f), Vec3(1, -1e-4f, 0), Vec3(1, 0, 0)}) {
        const Entity sun = shine(DirectionalLight{.illuminance = 3}, look_at(from, Vec3(0)));
        const gpu::FloatImage without = radiance(view);
        world.add(pool, Caustics{.resolution = 64});
        const gpu::FloatImage with = radiance(view);
        for (const float value : with.pixels) {
            REQUIRE(std::isfinite(value));
        }
        CHECK(largest_difference(with, without) < 1e-4f);
        world.remove<Caustics>(pool);
        world.destroy(sun);
    }
}

TEST_CASE_FIXTURE(Lake, "water veil: off the image center the path through the water is longer") {
    place(
        add(make_square()),
        add(Material{.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}}),
        affine_from({0, -9, -3}, {1, 0, 0, 0}, Vec3(6)));
    pour({.absorption = Vec3(0.3f), .scattering = Vec3(0)});
    const RenderView view = look({0, -9, 0}, {0, -9, -1}, 65, 65);
    const gpu::FloatImage image = radiance(view);
    for (const IVec2 pixel : {IVec2(32, 32), IVec2(2, 32), IVec2(60, 60), IVec2(10, 40)}) {
        const float path = 3 * glm::length(ray_through(view, pixel.x, pixel.y));
        CHECK(
            image.at(pixel.x, pixel.y, 0)
            == test::near(std::exp(-0.3f * path)).epsilon(0.01).scale(0));
    }
}

TEST_CASE_FIXTURE(Lake, "water veil: beyond the side of the water nothing is absorbed") {
    surround({1, 1, 1});
    pour({.size = {4, 6}, .absorption = {0.3f, 0.3f, 0.3f}, .scattering = Vec3(0)});
    for (const Vec3 toward : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
        const Vec3 eye = {0.5f, -5, -1};
        const gpu::FloatImage image = radiance(look(eye, eye + toward, 33, 33));
        const float path = toward.x != 0 ? 2 - toward.x * eye.x : 3 - toward.z * eye.z;
        CHECK(image.at(16, 16, 0) == test::near(std::exp(-0.3f * path)).epsilon(0.002).scale(0));
    }
}

TEST_CASE_FIXTURE(
    Lake, "water: a camera exactly on the surface gives a finite image, with any waves") {
    surround({0.5f, 0.7f, 1});
    shine(DirectionalLight{.illuminance = 2}, look_at({1, 0.0f, 0}, Vec3(0)));
    const Water water = {.depth = 2};
    const Entity lake = pour(water);
    for (int part = 0; part < 3; ++part) {
        if (part == 1) {
            world.add(lake, make_ripples({.size = {4, 4}}, {.cell = 0.1f}, kStep));
        } else if (part == 2) {
            world.add(lake, table_at(water, 0));
        }
        WaterSurface surface;
        surface.water = water;
        const WaveTable table = table_at(water, 0);
        surface.waves = part == 2 ? &table : nullptr;
        const float height = sample_water(surface, {0, 0}).position.y;
        for (const Vec3 toward :
             {Vec3(1, 0, 0), Vec3(0, 1, 0.1f), Vec3(0, -1, 0.1f), Vec3(1, 1, 1)}) {
            const Vec3 eye = {0, height, 0};
            const gpu::FloatImage image = radiance(look(eye, eye + toward, 33, 33));
            for (const float value : image.pixels) {
                REQUIRE(std::isfinite(value));
                REQUIRE(value >= 0);
            }
        }
    }
}

TEST_CASE_FIXTURE(Lake, "water: tiles hold the highest surface in them and in those above") {
    pour({.size = {40, 40}});
    const MaterialId white = add(Material{});
    place(add(make_square()), white, affine_from({-3, 1, -4}, {1, 0, 0, 0}, {1, 2.5f, 1}));
    place(add(make_square()), white, affine_from({2, -1, -1}, {1, 0, 0, 0}, Vec3(1)));
    const RenderView view = look({0, 2, 4}, {0, 1, 0}, 150, 70);
    FrameGraph& graph = frame_graph(shared_renderer());
    const std::string names[] = {"highest in columns", "depth behind water"};
    for (const std::string& name : names) {
        graph.keep_named(name);
    }
    draw(view);
    const gpu::FloatImage tiles = gpu::read_floats(*graph.texture(graph.find(names[0])));
    const gpu::FloatImage image = gpu::read_floats(*graph.texture(graph.find(names[1])));
    for (const std::string& name : names) {
        graph.forget_named(name);
    }
    REQUIRE(tiles.width == 5);
    REQUIRE(tiles.height == 3);
    std::vector<float> highest(15, -layout::kNoHeight);
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const float depth = image.at(x, y, 0);
            const float d = depth > 0 ? view.near / depth : 0;
            const int row = 2 - (view.height - 1 - y) / layout::kHighestTile;  // from the top
            float& highest_here =
                highest[static_cast<std::size_t>(5 * row + x / layout::kHighestTile)];
            highest_here =
                d > 0 ? std::max(highest_here, eye_of(view).y + ray_through(view, x, y).y * d)
                      : highest_here;
        }
    }
    CHECK(std::ranges::count(highest, -layout::kNoHeight) >= 5);
    CHECK(std::ranges::count_if(highest, [](float h) { return h > 3; }) >= 1);
    for (int i = 0; i < 15; ++i) {
        CAPTURE(i);
        const float here = highest[static_cast<std::size_t>(i)];
        const float over = i < 5 ? -layout::kNoHeight : tiles.at(i % 5, i / 5 - 1, 1);
        CHECK(tiles.at(i % 5, i / 5, 0) == test::near(here).epsilon(1e-3));
        CHECK(tiles.at(i % 5, i / 5, 1) == test::near(std::max(here, over)).epsilon(1e-3));
    }
    CHECK(tiles.at(1, 2, 1) > tiles.at(1, 2, 0) + 0.5f);  // the column of the wall
}

TEST_CASE_FIXTURE(Lake, "water: a pool looks the same with and without a sea in the world") {
    surround({0.5f, 0.7f, 1});
    shine(DirectionalLight{.illuminance = 2}, look_at({1, 1, 0}, Vec3(0)));
    const Entity pool = pour({.size = {8, 8}, .depth = 2});
    world.add(pool, make_rough({.size = {8, 8}}, 0.1f));
    const RenderView view = look({0, 1, 0.3f}, {0, 0, 0}, 64, 36);
    const gpu::FloatImage alone = radiance(view);

    const Ocean ocean = {.wind_speed = 5, .cascades = 2, .resolution = 32};
    OceanState state;
    step_ocean(ocean, kNow, kStep, state);
    world.add(pour({}, at({0, -40, 0})), state);
    const gpu::FloatImage beside = radiance(view);
    int same = 0;
    int shown = 0;
    for (std::size_t i = 0; i < alone.pixels.size(); i += 4) {
        shown += alone.pixels[i] > 0 ? 1 : 0;
        same += std::abs(beside.pixels[i] - alone.pixels[i]) <= 1e-3f ? 1 : 0;
    }
    CHECK(shown == 64 * 36);
    CHECK(same == 64 * 36);
}

TEST_CASE("foam pattern: its values are uniformly distributed, and it has no seam") {
    const std::vector<std::vector<std::uint8_t>> levels = make_foam_pattern();
    REQUIRE(levels.size() == 9);
    const std::vector<std::uint8_t>& pattern = levels[0];
    constexpr auto side = static_cast<std::size_t>(kFoamPatternSide);
    REQUIRE(pattern.size() == side * side);
    std::array<std::size_t, 256> counts{};
    for (const std::uint8_t value : pattern) {
        ++counts[value];
    }
    CHECK(std::all_of(counts.begin(), counts.end(), [&](std::size_t n) { return n == side; }));
    // How much neighbors differ, in the mean, over each row and each column.
    const auto step_after = [&](std::size_t line, std::size_t along, std::size_t across) {
        int sum = 0;
        for (std::size_t i = 0; i < side; ++i) {
            const std::size_t here = line * across + i * along;
            const std::size_t next = (line + 1) % side * across + i * along;
            sum += std::abs(int{pattern[here]} - int{pattern[next]});
        }
        return sum;
    };
    for (const auto& [along, across] :
         {std::pair(std::size_t{1}, side), std::pair(side, std::size_t{1})}) {
        int most = 0;
        for (std::size_t line = 0; line + 1 < side; ++line) {
            most = std::max(most, step_after(line, along, across));
        }
        CHECK(step_after(side - 1, along, across) <= most);
    }
}

TEST_CASE_FIXTURE(Lake, "water: foam that covers a fraction of the sea whitens that fraction") {
    surround({1, 1, 1});
    const Ocean calm = {.wind_speed = 0, .cascades = 1, .resolution = 32};
    OceanState state;
    step_ocean(calm, kNow, kStep, state);
    const Entity sea = world.create(
        Water{.absorption = {100, 100, 100}, .scattering = Vec3(0)}, WorldTransform{at({0, 0, 0})},
        state, OceanFoam{});
    for (const float height : {6.0f, 20.0f, 60.0f}) {
        const RenderView view = look({0, height, 0.1f}, {0, 0, 0}, 96, 96);
        const auto mean_with = [&](float cover) {
            world.get<OceanFoam>(sea).coverage.assign(32 * 32, cover);
            const gpu::FloatImage image = radiance(view);
            double sum = 0;
            for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
                sum += image.pixels[i];
            }
            return sum / (96 * 96);
        };
        const double bare = mean_with(0);
        for (const float cover : {0.05f, 0.3f, 0.6f, 1.0f}) {
            CAPTURE(height);
            CAPTURE(cover);
            const double white = cover * (0.4 + 0.6 * cover);
            const double expected = bare + white * (0.7 - bare);
            const double uv = (mean_with(cover) - bare) / (expected - bare);
            CHECK(uv < 1.1);
            CHECK(uv > (cover > 0.1f ? 0.85 : 0.2));  // thin foam drowns in the filter
        }
    }
}

TEST_CASE_FIXTURE(Lake, "water: a hundred rippling pools take as many calls as one") {
    surround({1, 1, 1});
    const RenderView view = look({0, 6, 12}, {0, 0, 0});
    const auto calls = [&] {
        draw(view);  // makes what is made once
        shared_device().reset_stats();
        draw(view);
        return shared_device().stats();
    };
    std::vector<gpu::DeviceStats> counts;
    for (int i = 0; i < 100; ++i) {
        const Water water = {.size = Vec2(0.4f + 0.004f * static_cast<float>(i)), .depth = 1};
        const Entity pool = pour(
            water,
            at({-9 + 2 * static_cast<float>(i % 10), 0, -9 + 2 * static_cast<float>(i / 10)}));
        world.add(pool, make_rough(water, 0.1f));
        if (i == 0 || i == 99) {
            counts.push_back(calls());
        }
    }
    CHECK(counts[0].draws == counts[1].draws);
    CHECK(counts[0].dispatches == counts[1].dispatches);
    CHECK(counts[0].state_changes == counts[1].state_changes);
}

}  // namespace limn::test::water_drawing_test
