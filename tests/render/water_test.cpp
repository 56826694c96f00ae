#include "ecs/base/optics.h"
#include "ecs/components/time.h"
#include "ecs/components/water.h"
#include "ecs/components/water_ripples.h"
#include "ecs/components/water_waves.h"
#include "render/graph/frame_graph.h"
#include "render/water/ripple_atlas.h"
#include "render/water/water_patches.h"
#include "systems/water/ocean_system.h"
#include "systems/water/water_query.h"
#include "systems/water/water_ripple_field.h"
#include "systems/water/water_wave_table.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace limn::test::water_test {
namespace {

class Pond : public Scene {
  public:
    Pond() {
        world.insert_resource(FrameTime{.step = 1.0f / 60, .time = 2.5});
        world.insert_resource(Exposure{});
    }

    Entity pour(const Water& water, const Affine& pose = at({0, 0, 0})) {
        return world.create(water, WorldTransform{pose});
    }
    /// Everything around has this radiance.
    void surround(const Vec3& color) {
        world.insert_resource(Environment{
            .sky = SkyKind::Uniform,
            .zenith = color,
            .horizon = color,
            .ground = color,
            .visible = true});
    }
    /// A square of side 2 `half` at height y that glows with `color`.
    void floor(float y, float half, const Vec3& color) {
        place(
            add(make_square()),
            add(Material{.shading = ShadingModel::Unlit, .base_color = Vec4(color, 1)}),
            affine_from(
                {0, y, 0}, glm::angleAxis(radians(-90), Vec3(1, 0, 0)), {half, half, half}));
    }
    /// Points of the surface as the image shows them, in the world.
    std::vector<Vec3> surface_points(const RenderView& view) {
        const gpu::FloatImage depth = aov(view, "depth");
        std::vector<Vec3> points;
        for (int y = 2; y < view.height; y += 5) {
            for (int x = 2; x < view.width; x += 5) {
                const float d = depth.at(x, y, 0);
                if (d < 1000) {
                    points.push_back(ray_through(view, x, y) * d + eye_of(view));
                }
            }
        }
        return points;
    }
    static Vec3 eye_of(const RenderView& view) {
        const Affine& pose = view.world_from_camera;
        return {pose.row[0].w, pose.row[1].w, pose.row[2].w};
    }
    /// One meter along the axis of the view.
    static Vec3 ray_through(const RenderView& view, int x, int y) {
        const Vec2 ndc = Vec2(
                             (static_cast<float>(x) + 0.5f) / static_cast<float>(view.width),
                             1 - (static_cast<float>(y) + 0.5f) / static_cast<float>(view.height))
                             * 2.0f
                         - 1.0f;
        const Affine& pose = view.world_from_camera;
        const auto column = [&](int c) {
            return Vec3(pose.row[0][c], pose.row[1][c], pose.row[2][c]);
        };
        return ndc.x * view.tangent.x * column(0) + ndc.y * view.tangent.y * column(1) - column(2);
    }
};

PatchSource source_of(const Vec2& half, const Vec3& camera) {
    PatchSource source;
    source.half = half;
    source.camera = camera;
    for (Vec4& plane : source.frustum.planes) {
        plane = {0, 0, 0, 1};  // sees everything
    }
    source.finest = 0.5f;
    return source;
}

}  // namespace

TEST_CASE("water patches: they cover the water exactly once") {
    for (const Vec2 half : {Vec2(20, 20), Vec2(37, 9)}) {
        std::vector<WaterPatch> patches;
        append_water_patches(source_of(half, {3, 1, -2}), patches);
        CHECK(patches.size() > 20);
        for (int i = 0; i < 500; ++i) {
            const Vec2 at(
                0.999f * half.x * std::sin(1.3f * static_cast<float>(i)),
                0.999f * half.y * std::cos(2.1f * static_cast<float>(i)));
            const auto covers = [&](const WaterPatch& p) {
                const Vec2 from = at - p.corner;
                return from.x >= 0 && from.y >= 0 && from.x < p.size && from.y < p.size;
            };
            CHECK(std::count_if(patches.begin(), patches.end(), covers) == 1);
        }
    }
}

TEST_CASE(
    "water patches: they are finer near the camera, and no neighbor is more than twice as large") {
    std::vector<WaterPatch> patches;
    const PatchSource source = source_of({0, 0}, {100, 2, 50});
    append_water_patches(source, patches);
    CHECK(patches.size() < 2000);
    float smallest = 1e9f;
    float largest = 0;
    for (const WaterPatch& a : patches) {
        smallest = std::min(smallest, a.size);
        largest = std::max(largest, a.size);
        for (const WaterPatch& b : patches) {
            const Vec2 gap =
                glm::max(a.corner, b.corner) - glm::min(a.corner + a.size, b.corner + b.size);
            if (gap.x <= 0 && gap.y <= 0) {
                CHECK(a.size <= 2 * b.size);
            }
        }
        // Where a larger neighbor begins, all of its vertices have slid onto every second one.
        CHECK(a.morph_end == test::near(2 * source.detail * a.size));
    }
    CHECK(smallest < 1);
    CHECK(largest > 1000);
}

TEST_CASE("water patches: along each ray from the camera nearer ones come first") {
    const Vec2 halves[] = {{0, 0}, {90, 40}};
    for (const Vec2& half : halves) {
        const Vec3 camera = {13, 2, -21};
        std::vector<WaterPatch> patches;
        append_water_patches(source_of(half, camera), patches);
        for (int direction = 0; direction < 32; ++direction) {
            const float angle = static_cast<float>(direction) * 0.19635f + 0.1f;
            const Vec2 along = {std::cos(angle), std::sin(angle)};
            std::size_t last = 0;
            for (float distance = 0.25f; distance < 200; distance *= 1.03f) {
                const Vec2 point = Vec2(camera.x, camera.z) + distance * along;
                const auto covers = [&](const WaterPatch& p) {
                    const Vec2 end = p.corner + p.size;
                    return glm::all(glm::greaterThanEqual(point, p.corner))
                           && glm::all(glm::lessThan(point, end));
                };
                const auto found = std::find_if(patches.begin(), patches.end(), covers);
                if (found != patches.end()) {
                    const auto index = static_cast<std::size_t>(found - patches.begin());
                    CHECK(index >= last);
                    last = index;
                }
            }
        }
    }
}

TEST_CASE("water patches: they are fixed in the water, however the camera moves") {
    std::vector<WaterPatch> patches;
    append_water_patches(source_of({0, 0}, {1234.5f, 2, -99.9f}), patches);
    for (const WaterPatch& p : patches) {
        CHECK(std::abs(p.corner.x / p.size - std::round(p.corner.x / p.size)) < 1e-4f);
        CHECK(std::log2(kWaterRange / p.size) == std::round(std::log2(kWaterRange / p.size)));
    }
}

TEST_CASE("water patches: vertices omit exactly the waves that are too short for them") {
    std::vector<WaveLine> lines;
    for (const float length : {19.0f, 11.0f, 4.0f, 2.5f, 0.9f, 0.8f}) {
        lines.push_back({.k = {0, 2 * kPi / length}, .amplitude = 0.02f * length});
    }
    std::vector<WaterPatch> patches;
    for (const float size : {0.4f, 3.5f, 15.9f, 16.1f, 200.0f}) {
        patches.push_back({.size = size});
    }
    resolve_lines(lines, patches);
    const float expected[] = {6, 5, 3, 2, 0};  // two vertices per wave, eight cells per side
    for (std::size_t i = 0; i < patches.size(); ++i) {
        CAPTURE(patches[i].size);
        CHECK(patches[i].lines == expected[i]);
        // Each of these waves is as steep as the others: slopes of 0.04 pi times a sine.
        const float steepness = 0.5f * square(0.04f * kPi);
        CHECK(patches[i].variance == test::near((6 - expected[i]) * steepness));
    }
}

TEST_CASE("water patches: there are never more than the maximum, with any settings") {
    std::vector<WaterPatch> patches;
    PatchSource source = source_of({0, 0}, {0, 0.1f, 0});
    source.finest = 1e-6f;
    source.detail = 40;
    append_water_patches(source, patches);
    CHECK(patches.size() <= static_cast<std::size_t>(kMaxWaterPatches));
    source.camera.x = std::numeric_limits<float>::quiet_NaN();
    append_water_patches(source, patches);
    CHECK(patches.size() <= static_cast<std::size_t>(kMaxWaterPatches));
}

TEST_CASE("ripple atlas: rectangles do not overlap") {
    const IVec2 sizes[] = {{10, 4}, {3, 9}, {7, 7}, {0, 0}, {12, 2}, {5, 5}, {8, 1}};
    IVec2 corners[7];
    const int height = pack_shelves(sizes, 14, corners);
    for (int i = 0; i < 7; ++i) {
        CHECK(corners[i].x + sizes[i].x <= 14);
        CHECK(corners[i].y + sizes[i].y <= height);
        for (int j = 0; j < i; ++j) {
            const IVec2 gap = glm::max(corners[i], corners[j])
                              - glm::min(corners[i] + sizes[i], corners[j] + sizes[j]);
            CHECK((gap.x >= 0 || gap.y >= 0 || sizes[i].x == 0 || sizes[j].x == 0));
        }
    }
}

TEST_CASE_FIXTURE(Pond, "water: without water there is no pass, and the image is bit-identical") {
    surround({1, 1, 1});
    floor(-1, 3, {0.2f, 0.5f, 0.7f});
    const RenderView view = look({0, 2, 3}, {0, 0, 0});
    const gpu::FloatImage without = radiance(view);
    CHECK_FALSE(frame_graph(shared_renderer()).was_run("water"));
    CHECK_FALSE(frame_graph(shared_renderer()).was_run("behind water"));
    pour({.size = {2, 2}}, at({0, 0, 50}));  // behind the camera
    CHECK(radiance(view).pixels == without.pixels);
    CHECK_FALSE(frame_graph(shared_renderer()).was_run("water"));
}

TEST_CASE_FIXTURE(Pond, "water: dark and deep, it reflects the sky by the Fresnel equations") {
    surround({1, 1, 1});
    pour({.absorption = Vec3(1000), .scattering = Vec3(0)});
    const RenderView view = look({0, 1, 0}, {0, 0.3f, -1}, 64, 64);
    const gpu::FloatImage image = radiance(view);
    int tested = 0;
    for (int y = 30; y < 64; y += 3) {
        const Vec3 ray = glm::normalize(ray_through(view, 32, y));
        if (-ray.y > 0.02f) {
            CAPTURE(y);
            CHECK(image.at(32, y, 0) == test::near(fresnel(-ray.y, 1.333f)).epsilon(0.01).scale(0));
            ++tested;
        }
    }
    CHECK(tested > 5);
}

TEST_CASE_FIXTURE(Pond, "water: light is absorbed along its path by the law of Beer and Lambert") {
    floor(-1.5f, 40, {0.8f, 0.6f, 0.4f});
    const Vec3 absorption = {0.5f, 0.2f, 0.05f};
    pour({.size = {60, 60}, .depth = 1.5f, .absorption = absorption, .scattering = Vec3(0)});
    const gpu::FloatImage image = radiance(look({0, 3, 0}, {0, 0, 0}));
    for (int c = 0; c < 3; ++c) {
        const float through = 1 - fresnel(1, 1.333f);
        const float expected =
            through * Vec3(0.8f, 0.6f, 0.4f)[c] * std::exp(-1.5f * absorption[c]);
        CHECK(image.at(32, 32, c) == test::near(expected).epsilon(0.01).scale(0));
    }
}

TEST_CASE_FIXTURE(Pond, "water: with the index and absorption of air it is invisible") {
    surround({0.5f, 0.6f, 0.9f});
    floor(-1, 2, {0.8f, 0.6f, 0.4f});
    const RenderView view = look({0, 2, 3}, {0, -0.5f, 0});
    const gpu::FloatImage without = radiance(view);
    pour(
        {.size = {20, 20},
         .refractive_index = 1.0001f,
         .absorption = Vec3(0),
         .scattering = Vec3(0)});
    const gpu::FloatImage with = radiance(view);
    int differ = 0;
    for (std::size_t i = 0; i < with.pixels.size(); ++i) {
        differ += std::abs(with.pixels[i] - without.pixels[i]) > 0.01f ? 1 : 0;
    }
    CHECK(differ < static_cast<int>(with.pixels.size()) / 50);  // the edge of the floor, by a pixel
}

TEST_CASE_FIXTURE(Pond, "water: the bottom appears nearer, by the refractive index") {
    // Straight down a mark at depth 2 looks as if at 2 / 1.333.
    floor(-2, 40, {0, 0, 0});
    place(
        add(make_square()),
        add(Material{.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}}),
        affine_from({0, -1.99f, 0}, glm::angleAxis(radians(-90), Vec3(1, 0, 0)), Vec3(0.5f)));
    pour({.size = {60, 60}, .depth = 2, .absorption = Vec3(0), .scattering = Vec3(0)});
    const gpu::FloatImage image = radiance(look({0, 1, 0}, {0, 0, 0}, 256, 256));
    int lit = 0;
    for (int x = 0; x < 256; ++x) {
        lit += image.at(x, 128, 0) > 0.5f ? 1 : 0;
    }
    const double half_angle = std::atan(0.5 / (1 + 1.99 / 1.333));  // of small angles
    CHECK(lit == test::near(256 * std::tan(half_angle)).epsilon(0.05).scale(0));
}

TEST_CASE_FIXTURE(Pond, "water: the drawn surface matches the query, for waves, ripples and sea") {
    const Water water = {.size = {40, 40}, .absorption = Vec3(1)};
    const Affine pose = affine_from({1, 0.5f, -2}, glm::angleAxis(0.7f, Vec3(0, 1, 0)), {1, 1, 1});
    WaveTable table;
    fill_wave_table(
        water,
        {.waves =
             {{.amplitude = 0.2f, .length = 9, .direction = 1, .sharpness = 1},
              {.amplitude = 0.1f, .length = 6, .direction = -1, .lean = 0.3f}},
         .radial = {{.amplitude = 0.1f, .length = 7}},
         .packets = {{.age = 1.5f, .amplitude = 0.1f, .length = 4, .waves = 1}}},
        2.5, table);
    RippleState ripples = make_ripples(water, {.cell = 0.5f}, 1.0f / 60);
    push_ripples(ripples, {.center = {1, 2}, .radius = 6, .height = -0.4f});
    OceanState sea;
    step_ocean(
        {.wind_speed = 4, .cascades = 2, .patch = 60, .resolution = 32}, 2.5, 1.0f / 60, sea);
    for (int part = 0; part < 4; ++part) {
        const Entity pond = pour(water, pose);
        WaterSurface surface;
        surface.frame = water_frame(pose);
        surface.water = water;
        if (part == 0 || part == 3) {
            world.add(pond, table);
            surface.waves = &table;
        }
        if (part == 1 || part == 3) {
            world.add(pond, ripples);
            surface.ripples = &ripples;
        }
        if (part == 2 || part == 3) {
            world.add(pond, sea);
            surface.ocean = &sea;
        }
        CAPTURE(part);
        const RenderView view = look({2, 4, 5}, {0, 0.3f, 0}, 96, 64);
        const std::vector<Vec3> points = surface_points(view);
        CHECK(points.size() > 150);
        double worst = 0;
        double squares = 0;
        for (const Vec3& p : points) {
            const WaterPoint expected = sample_water(surface, {p.x, p.z});
            if (expected.is_water) {
                const float pixel = glm::distance(p, eye_of(view)) * 2 / 64;  // its side there
                const double off = static_cast<double>(std::abs(p.y - expected.position.y) / pixel);
                worst = std::max(worst, off);
                squares += off * off / static_cast<double>(points.size());
            }
        }
        CHECK(std::sqrt(squares) < 0.02);  // pixels: flat triangles between true points
        CHECK(worst < 0.2);
        world.destroy(pond);
    }
}

TEST_CASE_FIXTURE(
    Pond, "water: without ripples it is flat, also at its origin, even if others have some") {
    pour({.size = {40, 40}});
    const Water other = {.size = {2, 2}};
    RippleState raised = make_ripples(other, {.cell = 0.25f}, 1.0f / 60);
    std::fill(raised.height.begin(), raised.height.end(), 0.5f);
    std::fill(raised.previous.begin(), raised.previous.end(), 0.5f);
    world.create(other, WorldTransform{at({500, 0, 0})}, std::move(raised));
    const RenderView view = look({0, 3, 6}, {0, 0, 0}, 64, 48);
    const gpu::FloatImage depth = aov(view, "depth");
    float highest = -1;
    for (int y = 16; y < 32; ++y) {
        for (int x = 24; x < 40; ++x) {
            const float ray_y = ray_through(view, x, y).y;
            highest = std::max(highest, eye_of(view).y + depth.at(x, y, 0) * ray_y);
        }
    }
    CHECK(highest == test::near(0).scale(1).epsilon(0.01));
}

TEST_CASE_FIXTURE(Pond, "water: its velocity is that of the surface; at rest it has none") {
    const Entity pond = pour({.size = {40, 40}});
    const RenderView view = look({0, 3, 6}, {0, 0, 0}, 64, 48);
    const gpu::FloatImage still = aov(view, "velocity");
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 64; ++x) {
            CHECK((still.at(x, y, 0) == 0 && still.at(x, y, 1) == 0));
        }
    }
    WaveTable table;
    const WaterWaves waves = {.waves = {{.amplitude = 0.3f, .length = 12, .sharpness = 1}}};
    fill_wave_table({}, waves, 2.5, table);
    world.add(pond, table);
    const gpu::FloatImage moving = aov(view, "velocity");
    const gpu::FloatImage depth = aov(view, "depth");
    WaveTable before;
    fill_wave_table({}, waves, 2.5 - 1.0 / 60, before);
    WaterSurface surface;
    surface.water = {.size = {40, 40}};
    surface.waves = &table;
    int tested = 0;
    for (int y = 20; y < 48; y += 4) {
        for (int x = 3; x < 64; x += 7) {
            const float d = depth.at(x, y, 0);
            if (d > 100) {
                continue;
            }
            const Vec3 now = ray_through(view, x, y) * d + eye_of(view);
            const WaterPoint point = sample_water(surface, {now.x, now.z});
            const Vec3 rest(point.rest.x, 0, point.rest.y);
            const Vec3 is = rest + evaluate_waves(table, point.rest).offset;
            const Vec3 was = rest + evaluate_waves(before, point.rest).offset;
            const auto pixel = [&](const Vec3& p) {
                const Vec4 clip = view.unjittered_from_world * Vec4(p, 1);
                return Vec2(0.5f + 0.5f * clip.x / clip.w, 0.5f - 0.5f * clip.y / clip.w)
                       * Vec2(view.width, view.height);
            };
            const Vec2 expected = pixel(is) - pixel(was);
            CHECK(std::abs(moving.at(x, y, 0) - expected.x) < 0.05f);
            CHECK(std::abs(moving.at(x, y, 1) - expected.y) < 0.05f);
            ++tested;
        }
    }
    CHECK(tested > 20);
}

TEST_CASE_FIXTURE(Pond, "water: only pixels that show a pool change, each by its own parameters") {
    surround({0.1f, 0.1f, 0.1f});
    const RenderView view = look({0, 5, 0.1f}, {0, 0, 0});
    const gpu::FloatImage without = radiance(view);
    const gpu::FloatImage far = aov(view, "depth");
    const Water red = {.size = {2, 2}, .absorption = Vec3(0.5f), .scattering = {0.5f, 0, 0}};
    const Water green = {.size = {2, 2}, .absorption = Vec3(0.5f), .scattering = {0, 0.5f, 0}};
    pour(red, at({-1.5f, 0, 0}));
    pour(green, at({1.5f, 0, 0}));
    const gpu::FloatImage with = radiance(view);
    const gpu::FloatImage depth = aov(view, "depth");
    int pools[2] = {};
    int wrong = 0;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const Vec3 light = {with.at(x, y, 0), with.at(x, y, 1), with.at(x, y, 2)};
            if (depth.at(x, y, 0) == far.at(x, y, 0)) {
                wrong += light != Vec3(without.at(x, y, 0)) ? 1 : 0;
                continue;
            }
            const bool left = 2 * x < view.width;
            ++pools[left ? 0 : 1];
            wrong += left ? light.x <= light.y : light.y <= light.x;
        }
    }
    CHECK(wrong == 0);
    CHECK(pools[0] > 20);
    CHECK(pools[1] > 20);
}

TEST_CASE_FIXTURE(Pond, "water: a hundred pools take one draw call") {
    surround({1, 1, 1});
    const RenderView view = look({0, 6, 12}, {0, 0, 0});
    draw(view);
    const int none = draw(view).statistics.draws;
    for (int i = 0; i < 100; ++i) {
        const Water water = {.size = Vec2(0.4f + 0.004f * static_cast<float>(i)), .depth = 1};
        const Entity pool = pour(
            water,
            at({-9 + 2 * static_cast<float>(i % 10), 0, -9 + 2 * static_cast<float>(i / 10)}));
        RippleState ripples = make_ripples(water, {.cell = 0.1f}, 1.0f / 60);
        push_ripples(ripples, {.radius = 0.2f, .height = 0.05f});
        world.add(pool, ripples);
    }
    shared_device().reset_stats();
    const FrameOutput out = draw(view);
    CHECK(out.statistics.draws == none);
    CHECK(frame_graph(shared_renderer()).was_run("water"));
    CHECK(shared_device().stats().draws < 40);
}

TEST_CASE_FIXTURE(Pond, "water: from below, it reflects totally beyond the critical angle") {
    surround({1, 1, 1});
    pour({.absorption = Vec3(0), .scattering = Vec3(0)});
    const RenderView view = look({0, -1, 0}, {0, 0, -0.2f}, 128, 128);
    const gpu::FloatImage image = radiance(view);
    int inside = 0;
    int outside = 0;
    for (int y = 0; y < 128; y += 4) {
        for (int x = 0; x < 128; x += 4) {
            const Vec3 ray = glm::normalize(ray_through(view, x, y));
            const float angle = degrees(std::acos(std::clamp(ray.y, -1.0f, 1.0f)));
            const float light = image.at(x, y, 0);
            if (angle < 45) {
                CHECK(light > 0.8f);
                ++inside;
            } else if (angle > 50 && angle < 80) {
                CHECK(light < 0.1f);  // nothing scatters in it
                ++outside;
            }
        }
    }
    CHECK(inside > 50);
    CHECK(outside > 10);
}

TEST_CASE_FIXTURE(Pond, "water veil: under water, surfaces are dimmed by their distance") {
    const Vec3 absorption = {0.4f, 0.1f, 0.02f};
    place(
        add(make_square()),
        add(Material{.shading = ShadingModel::Unlit, .base_color = {0.8f, 0.6f, 0.4f, 1}}),
        affine_from({0, -4, -3}, {1, 0, 0, 0}, Vec3(3)));
    pour({.absorption = absorption, .scattering = Vec3(0)});
    const gpu::FloatImage image = radiance(look({0, -4, 0}, {0, -4, -1}, 65, 65));
    CHECK(frame_graph(shared_renderer()).was_run("water veil"));
    for (int c = 0; c < 3; ++c) {
        const float expected = Vec3(0.8f, 0.6f, 0.4f)[c] * std::exp(-3 * absorption[c]);
        CHECK(image.at(32, 32, c) == test::near(expected).epsilon(0.005).scale(0));
    }
}

TEST_CASE_FIXTURE(
    Pond, "water veil: above the water, outside it and below its bottom there is none") {
    surround({1, 1, 1});
    pour({.size = {4, 4}, .depth = 2});
    for (const Vec3 eye : {Vec3(0, 1, 0), Vec3(3, -1, 0), Vec3(0, -3, 0)}) {
        draw(look(eye, eye + Vec3(0, 0.1f, -1)));
        CHECK_FALSE(frame_graph(shared_renderer()).was_run("water veil"));
    }
    draw(look({0, -1, 0}, {0, -1, -1}));
    CHECK(frame_graph(shared_renderer()).was_run("water veil"));
}

TEST_CASE_FIXTURE(Pond, "water veil: unbounded water has one color, darker with depth") {
    surround({1, 1, 1});
    const Vec3 scattering = {0.01f, 0.02f, 0.04f};
    pour({.absorption = Vec3(0.2f), .scattering = scattering});
    float last = 1;
    for (const float depth : {2.0f, 4.0f, 8.0f}) {
        const gpu::FloatImage image =
            radiance(look({0, -depth, 0}, {0, -depth - 1, -0.01f}, 33, 33));
        CHECK(image.at(16, 16, 0) < image.at(16, 16, 1));
        CHECK(image.at(16, 16, 1) < image.at(16, 16, 2));
        CHECK(image.at(16, 16, 2) < last);
        // Straight down: a third of backscatter over extinction, of what is left of the light.
        const float extinction = 0.2f + scattering.z;
        const float expected =
            0.33f * scattering.z / extinction * std::exp(-1.2f * extinction * depth);
        CHECK(image.at(16, 16, 2) == test::near(expected).epsilon(0.02).scale(0));
        last = image.at(16, 16, 2);
    }
}

TEST_CASE_FIXTURE(
    Pond, "water veil: at the surface the water line is where the water crosses the lens") {
    // A camera in still water's plane: the lower half of the image is under it.
    place(
        add(make_square()),
        add(Material{.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}}),
        affine_from({0, 0, -3}, {1, 0, 0, 0}, Vec3(6)));
    const Entity pond = pour({.absorption = Vec3(0.3f), .scattering = Vec3(0)});
    for (const float height : {0.0f, 0.01f, -0.01f}) {
        const gpu::FloatImage image = radiance(look({0, height, 0}, {0, height, -1}, 64, 64));
        for (const float value : image.pixels) {
            REQUIRE(std::isfinite(value));
        }
        CHECK(image.at(32, 62, 0) < 0.5f);
        CHECK(image.at(32, 2, 0) == test::near(1).epsilon(0.01).scale(0));
    }
    // Waves move the line: a crest on the camera covers it.
    WaveTable table;
    fill_wave_table({}, {.waves = {{.amplitude = 0.2f, .length = 40, .phase = kPi / 2}}}, 0, table);
    world.add(pond, table);
    const gpu::FloatImage covered = radiance(look({0, 0.1f, 0}, {0, 0.1f, -1}, 64, 64));
    CHECK(covered.at(32, 20, 0) < 0.5f);
}

}  // namespace limn::test::water_test
