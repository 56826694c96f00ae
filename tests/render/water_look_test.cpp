#include "ecs/base/math.h"
#include "ecs/base/optics.h"
#include "ecs/components/time.h"
#include "ecs/components/water.h"
#include "ecs/components/water_look.h"
#include "ecs/components/water_waves.h"
#include "render/water/water_reflection.h"
#include "systems/water/water_query.h"
#include "systems/water/water_wave_table.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace limn::test::water_look_test {
namespace {

/// Of water so dark that it only mirrors.
constexpr Water kMirror = {.absorption = Vec3(1000), .scattering = Vec3(0)};

/// Things of plain colors above and below y = 0.3, and water there.
class Look : public Scene {
  public:
    Look() {
        world.insert_resource(FrameTime{.step = 1.0f / 60, .time = 2.5});
        world.insert_resource(Exposure{});
        world.insert_resource(Environment{
            .sky = SkyKind::Uniform,
            .zenith = Vec3(0.5f),
            .horizon = Vec3(0.5f),
            .ground = Vec3(0.5f),
            .visible = true});
    }
    Entity pour(const Water& water, float y = kLevel) {
        return world.create(water, WorldTransform{at({0, y, 0})});
    }
    Entity ball(const Vec3& center, float radius, const Vec3& color) {
        return place(
            add(make_ball(24)),
            add(Material{.shading = ShadingModel::Unlit, .base_color = Vec4(color, 1)}),
            affine_from(center, {1, 0, 0, 0}, Vec3(radius)));
    }
    void things_above() {
        ball({-1, 1.5f, -4}, 0.8f, {0.9f, 0.1f, 0.1f});
        ball({1.2f, 0.9f, -3}, 0.4f, {0.1f, 0.9f, 0.2f});
        ball({0.3f, 3.5f, -6}, 1.1f, {0.1f, 0.2f, 0.9f});
    }

    static constexpr float kLevel = 0.3f;
};

/// Unit, from the eye through the center of a pixel; row 0 is the top one.
Vec3 ray_through(const RenderView& view, int x, int y) {
    const Vec2 size(view.width, view.height);
    const Vec2 ndc =
        Vec2(static_cast<float>(x) + 0.5f, size.y - static_cast<float>(y) - 0.5f) / size * 2.0f
        - 1.0f;
    const auto& pose = view.world_from_camera.row;
    const Vec3 in_camera(ndc.x * view.tangent.x, ndc.y * view.tangent.y, -1);
    return glm::normalize(Vec3(
        glm::dot(Vec3(pose[0]), in_camera), glm::dot(Vec3(pose[1]), in_camera),
        glm::dot(Vec3(pose[2]), in_camera)));
}

/// What the image shows there, in the world.
Vec3 point_at(const RenderView& view, const gpu::FloatImage& depth, int x, int y) {
    const auto& pose = view.world_from_camera.row;
    const Vec3 axis = -Vec3(pose[0].z, pose[1].z, pose[2].z);
    const Vec3 ray = ray_through(view, x, y);
    return Vec3(pose[0].w, pose[1].w, pose[2].w) + ray * (depth.at(x, y, 0) / glm::dot(ray, axis));
}

}  // namespace

TEST_CASE_FIXTURE(Look, "water look: a default look is bit-identical to none") {
    things_above();
    const Entity pond = pour(kMirror);
    const RenderView view = look({0, 1.5f, 2}, {0, 0.8f, -3});
    const gpu::FloatImage plain = radiance(view);
    world.add(pond, WaterLook{});
    const FrameOutput out = draw(view);
    CHECK(gpu::read_floats(*out.radiance).pixels == plain.pixels);
    CHECK(out.statistics.water_reflections == 0);
}

TEST_CASE_FIXTURE(
    Look, "water look: from above it reflects by the chosen Fresnel term"
              * technique("water.fresnel-approx")) {
    world.resource<Environment>() = {
        .sky = SkyKind::Uniform, .zenith = Vec3(1), .horizon = Vec3(1), .ground = Vec3(1)};
    const Entity pond = pour(kMirror);
    const RenderView view = look({0, 1, 0}, {0, 0.3f, -1}, 64, 64);
    for (const WaterFresnel form : {WaterFresnel::Schlick, WaterFresnel::Angle}) {
        world.add(pond, WaterLook{.fresnel = form});
        const gpu::FloatImage image = radiance(view);
        int tested = 0;
        for (int y = 30; y < 64; y += 3) {
            const float cosine = -ray_through(view, 32, y).y;
            if (cosine > 0.02f) {
                CAPTURE(y);
                const float expected = form == WaterFresnel::Angle
                                           ? fresnel_tso_barsky(cosine)
                                           : fresnel_schlick(cosine, kMirror.refractive_index);
                CHECK(std::abs(image.at(32, y, 0) - expected) < 0.01f * expected);
                ++tested;
            }
        }
        CHECK(tested > 5);
        world.remove<WaterLook>(pond);
    }
}

TEST_CASE_FIXTURE(
    Look, "water look: with environment reflections only, objects are not reflected") {
    ball({0, 1.3f, -4}, 1, {0, 0, 4});
    const Entity pond = pour(kMirror);
    const RenderView view = look({0, 1.5f, 2}, {0, 0.3f, -2});
    const auto blueness = [&] {
        const Vec3 mirrored = rgb_at(radiance(view), 32, 32);
        return mirrored.z / std::max(mirrored.x, 1e-3f);
    };
    CHECK(blueness() > 5);
    world.add(pond, WaterLook{.reflection = WaterReflection::Environment});
    CHECK(blueness() == test::near(1).epsilon(0.01));
}

TEST_CASE(
    "water reflection: its camera is mirrored, and mirrored twice the original"
    * technique("water.reflection-refraction-maps")) {
    const RenderView view = with_jitter(
        make_render_view(
            {.fov_y = 1.0f, .near = 0.1f}, look_at({1, 2, 3}, {-2, 0.5f, -4}),
            look_at({1, 2, 3}, {-2, 0.5f, -4}), {.width = 200, .height = 100}),
        {0.25f, -0.4f});
    constexpr float kLevel = 0.7f;
    const RenderView mirrored = make_reflected_view(view, kLevel, 0.5f);
    CHECK(mirrored.width == 100);
    CHECK(mirrored.height == 50);
    const auto& pose = mirrored.world_from_camera.row;
    CHECK(pose[0].w == test::near(1));
    CHECK(pose[1].w == test::near(2 * kLevel - 2));
    CHECK(pose[2].w == test::near(3));
    // A camera that turns triangles around would see their backs.
    const glm::mat3 turned{Vec3(pose[0]), Vec3(pose[1]), Vec3(pose[2])};
    CHECK(glm::determinant(turned) == test::near(1));
    for (const Vec3 p : {Vec3(0, 1, -2), Vec3(-3, 0.2f, -5), Vec3(2, 5, -9)}) {
        const Vec4 image = view.clip_from_world * Vec4(p.x, 2 * kLevel - p.y, p.z, 1);
        const Vec4 found = mirrored.clip_from_world * Vec4(p, 1);
        CHECK(found.x == test::near(image.x));
        CHECK(found.y == test::near(-image.y));
        CHECK(found.w == test::near(image.w));
        // What is above the surface is shown, what is below is not.
        CHECK((glm::dot(mirrored.clip_plane, Vec4(p, 1)) >= 0) == (p.y >= kLevel));
    }
    const RenderView again = make_reflected_view(mirrored, kLevel, 1);
    for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r) {
            CHECK(
                again.unjittered_from_world[c][r] == test::near(view.unjittered_from_world[c][r]));
        }
    }
}

TEST_CASE_FIXTURE(
    Look, "water reflection: in flat water it is the image of a mirrored camera"
              * technique("water.reflection-refraction-maps")) {
    things_above();
    const Vec3 eye = {0, 1.6f, 2};
    const Vec3 target = {0, 0.3f, -2};
    const auto mirrored = [](const Vec3& p) { return Vec3(p.x, 2 * kLevel - p.y, p.z); };
    const gpu::FloatImage truth = radiance(look(mirrored(eye), mirrored(target), 96, 96));
    // It must not be visible: it is between that camera and the surface.
    ball({0.1f, -0.5f, 0.2f}, 0.6f, {9, 9, 0});
    world.add(pour(kMirror), WaterLook{.reflection = WaterReflection::Planar, .map_scale = 1});
    const RenderView view = look(eye, target, 96, 96);
    const FrameOutput out = draw(view);
    CHECK(out.statistics.water_reflections == 1);
    const gpu::FloatImage image = gpu::read_floats(*out.radiance);
    const gpu::FloatImage depth = aov(view, "depth");
    int tested = 0;
    double worst = 0;
    for (int y = 0; y < 96; ++y) {
        for (int x = 0; x < 96; ++x) {
            const Vec3 ray = ray_through(view, x, y);
            const Vec3 point = point_at(view, depth, x, y);
            if (ray.y > -0.1f || std::abs(point.y - kLevel) > 1e-3f) {
                continue;  // the sky, or what stands before the water
            }
            const float reflectance = fresnel(-ray.y, kMirror.refractive_index);
            for (int c = 0; c < 3; ++c) {
                const float expected = reflectance * truth.at(x, 95 - y, c);
                worst =
                    std::max<double>(worst, std::abs(image.at(x, y, c) - expected) / reflectance);
            }
            ++tested;
        }
    }
    CHECK(tested > 3000);
    CHECK(worst < 0.01);
}

TEST_CASE_FIXTURE(
    Look,
    "water reflection: traced on screen, near and far objects are reflected up to their edges") {
    ball({-0.6f, 0.9f, -1}, 0.5f, {0.9f, 0.1f, 0.1f});
    ball({1.2f, 0.9f, -3}, 0.4f, {0.1f, 0.9f, 0.2f});
    ball({20, 8, -200}, 40, {0.1f, 0.2f, 0.9f});
    const Vec3 eye = {0, 1.2f, 2};
    const Vec3 target = {0, 0.7f, -2};
    const auto mirrored = [](const Vec3& p) { return Vec3(p.x, 2 * kLevel - p.y, p.z); };
    constexpr int kSide = 240;
    const RenderView below = look(mirrored(eye), mirrored(target), kSide, kSide);
    const gpu::FloatImage truth = radiance(below);
    const gpu::FloatImage truth_depth = aov(below, "depth");
    pour(kMirror);
    const RenderView view = look(eye, target, kSide, kSide);
    const gpu::FloatImage image = radiance(view);
    const gpu::FloatImage depth = aov(view, "depth");
    // What the camera does not see, it cannot mirror.
    const auto is_hidden = [&](const Vec3& point) {
        const Vec4 clip = view.clip_from_world * Vec4(point, 1);
        const Vec2 pixel = (0.5f + 0.5f * Vec2(clip) / clip.w) * static_cast<float>(kSide);
        const int x = std::clamp(static_cast<int>(pixel.x), 0, kSide - 1);
        const int y = std::clamp(static_cast<int>(pixel.y), 0, kSide - 1);
        return std::abs(depth.at(x, kSide - 1 - y, 0) - clip.w) > 0.02f * clip.w;
    };
    int objects = 0;
    int wrong = 0;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const Vec3 ray = ray_through(view, x, y);
            const Vec3 point = point_at(view, depth, x, y);
            if (ray.y > -0.02f || std::abs(point.y - kLevel) > 1e-3f) {
                continue;  // the sky, or what stands before the water
            }
            const float reflectance = fresnel(-ray.y, kMirror.refractive_index);
            const Vec3 expected = rgb_at(truth, x, kSide - 1 - y);
            const bool is_sky = expected == Vec3(0.5f);
            if (!is_sky && is_hidden(point_at(below, truth_depth, x, kSide - 1 - y))) {
                continue;
            }
            bool at_edge = false;  // exact to two pixels
            for (const auto& [dx, dy] : {std::pair{-2, 0}, {2, 0}, {0, -2}, {0, 2}}) {
                const int u = std::clamp(x + dx, 0, kSide - 1);
                const int v = std::clamp(kSide - 1 - y + dy, 0, kSide - 1);
                at_edge = at_edge || rgb_at(truth, u, v) != expected;
            }
            if (at_edge) {
                continue;
            }
            const Vec3 difference = glm::abs(rgb_at(image, x, y) / reflectance - expected);
            objects += is_sky ? 0 : 1;
            wrong += std::max({difference.x, difference.y, difference.z}) > 0.05f ? 1 : 0;
        }
    }
    CAPTURE(objects);
    CAPTURE(wrong);
    CHECK(objects > 1500);
    CHECK(wrong < 0.05 * objects);
}

TEST_CASE_FIXTURE(
    Look, "water reflection: traced on screen, waves reflect far bodies as the mean of many rays, "
          "without specks") {
    // Bright balls toward the horizon, which a small part of each wave mirrors.
    for (int i = -12; i <= 12; ++i) {
        const auto x = static_cast<float>(i);
        ball({1.7f * x, 0.7f, -16 - 4 * std::abs(std::sin(7 * x))}, 0.5f, {4, 4, 4});
    }
    const WaterWaves waves = {
        .groups = {{.count = 24, .length = {0.6f, 4}, .amplitude = {0.01f, 0.05f}, .spread = 2}}};
    WaveTable table;
    fill_wave_table(kMirror, waves, 0, table);
    world.create(kMirror, waves, table, WorldTransform{at({0, kLevel, 0})});
    constexpr int kSide = 160;
    constexpr int kFine = 6;  // rays along each side of a pixel
    const auto image_of = [&](int side) {
        return radiance(look({0, 3, 2}, {0, 0.2f, -5}, side, side));
    };
    const gpu::FloatImage image = image_of(kSide);
    const gpu::FloatImage fine = image_of(kFine * kSide);
    double squares = 0;
    int specks = 0;
    for (int y = kSide / 2; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            double mean = 0;
            for (int i = 0; i < kFine * kFine; ++i) {
                mean +=
                    static_cast<double>(fine.at(kFine * x + i % kFine, kFine * y + i / kFine, 0))
                    / (kFine * kFine);
            }
            const double error = static_cast<double>(image.at(x, y, 0)) - mean;
            squares += error * error;
            specks += std::abs(error) > 0.25 ? 1 : 0;
        }
    }
    CHECK(std::sqrt(squares / (kSide * kSide / 2)) < 0.02);  // 0.036 with one ray a pixel
    CHECK(specks < 15);                                      // 47
}

TEST_CASE_FIXTURE(
    Look, "water reflection: traced on screen, what a ray passes far behind is not reflected") {
    // A blue ramp that rises away from the camera, with a red edge, before a distant green wall. In
    // the image, rays from the water cross it from below: those close behind may show its edge,
    // none what is above, however near they get.
    const auto board = [&](const Vec3& center, const Vec2& half, float pitch, const Vec3& color) {
        place(
            add(make_square()),
            add(Material{.shading = ShadingModel::Unlit, .base_color = Vec4(color, 1)}),
            affine_from(center, glm::angleAxis(pitch, Vec3(1, 0, 0)), Vec3(half, 1)));
    };
    const Vec2 rise = {0.5f, 6};
    const float pitch = -std::atan2(rise.y, rise.x);
    const auto on_ramp = [&](float at) { return Vec3(0, 0.95f + at * rise.x, -4 - at * rise.y); };
    const float length = glm::length(rise);
    board(on_ramp(0.05f), {9, 0.05f * length}, pitch, {0.9f, 0.1f, 0.1f});
    board(on_ramp(0.55f), {9, 0.45f * length}, pitch, {0.1f, 0.1f, 0.9f});
    board({0, 4, -14}, {40, 8}, 0, {0.1f, 0.9f, 0.2f});
    const Vec3 eye = {0, 1.6f, 2};
    const Vec3 target = {0.6f, 0.9f, -4};
    const auto mirrored = [](const Vec3& p) { return Vec3(p.x, 2 * kLevel - p.y, p.z); };
    constexpr int kSide = 240;
    const gpu::FloatImage truth = radiance(look(mirrored(eye), mirrored(target), kSide, kSide));
    pour(kMirror);
    const RenderView view = look(eye, target, kSide, kSide);
    const gpu::FloatImage image = radiance(view);
    const gpu::FloatImage depth = aov(view, "depth");
    const auto is_blue = [](const Vec3& color) { return color.z > 2 * color.y; };
    int tested = 0;
    int wrong = 0;
    for (int y = 4; y < kSide - 4; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const Vec3 ray = ray_through(view, x, y);
            const bool is_water = std::abs(point_at(view, depth, x, y).y - kLevel) < 1e-3f;
            bool mirrors_board = false;  // within two pixels
            for (int dy = -2; dy <= 2; ++dy) {
                mirrors_board = mirrors_board || is_blue(rgb_at(truth, x, kSide - 1 - y + dy));
            }
            if (ray.y < -0.02f && is_water && !mirrors_board) {
                wrong += is_blue(rgb_at(image, x, y)) ? 1 : 0;
                ++tested;
            }
        }
    }
    CAPTURE(wrong);
    CHECK(tested > 10'000);
    CHECK(wrong == 0);
}

TEST_CASE_FIXTURE(
    Look, "water reflection: a mirrored ray that goes down meets the water, not the ground") {
    // Waves so steep that they mirror one another.
    world.resource<Environment>() = {
        .sky = SkyKind::Gradient, .zenith = {0, 0, 1}, .horizon = {0, 0, 1}, .ground = {1, 0, 0}};
    const Entity pond = pour({.size = {60, 60}, .absorption = Vec3(1000), .scattering = Vec3(0)});
    WaveTable table;
    fill_wave_table(
        world.get<Water>(pond),
        {.waves = {{.amplitude = 0.3f, .length = 2.5f, .direction = kPi / 2}}}, 2.5, table);
    world.add(pond, table);
    const gpu::FloatImage image = radiance(look({0, 1.6f, 4}, {0, 0.9f, -4}, 96, 96));
    double red = 0;
    double blue = 0;
    for (int y = 60; y < 96; ++y) {
        for (int x = 0; x < 96; ++x) {
            red += image.at(x, y, 0);
            blue += image.at(x, y, 2);
        }
    }
    CHECK(blue > 100);
    CHECK(red < 0.01 * blue);
}

TEST_CASE_FIXTURE(
    Look, "water reflection: waves shift it to the reflected point, or not at all"
              * technique("water.reflection-refraction-maps")) {
    // A wall whose color tells where it is.
    MeshData wall = make_square();
    wall.colors = {{0, 0, 0, 1}, {1, 0, 0, 1}, {1, 1, 0, 1}, {0, 1, 0, 1}};
    place(
        add(wall), add(Material{.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}}),
        affine_from({0, 0, -8}, {1, 0, 0, 0}, Vec3(12)));
    const Water water = {.size = {30, 14}, .absorption = Vec3(1000), .scattering = Vec3(0)};
    const Entity pond = world.create(water, WorldTransform{at({0, 0, 0})});
    WaveTable table;
    fill_wave_table(
        water, {.waves = {{.amplitude = 0.02f, .length = 4, .direction = 0.6f}}}, 2.5, table);
    world.add(pond, table);
    WaterSurface surface;
    surface.frame = water_frame(at({0, 0, 0}));
    surface.water = water;
    surface.waves = &table;
    const Vec3 eye = {0, 2.5f, 5};
    const RenderView view = look(eye, {0, 0.5f, -3}, 96, 96);
    const gpu::FloatImage depth = aov(view, "depth");
    const auto mean_error = [&](float distortion, bool flat) {
        world.add(
            pond,
            WaterLook{
                .reflection = WaterReflection::Planar, .distortion = distortion, .map_scale = 1});
        const gpu::FloatImage image = radiance(view);
        world.remove<WaterLook>(pond);
        double sum = 0;
        int tested = 0;
        for (int y = 56; y < 74; ++y) {
            for (int x = 20; x < 76; ++x) {
                const Vec3 ray = ray_through(view, x, y);
                const Vec3 p = point_at(view, depth, x, y);
                const WaterPoint at = sample_water(surface, {p.x, p.z});
                const float reflectance =
                    fresnel(-glm::dot(ray, at.normal), water.refractive_index);
                const Vec3 start = flat ? Vec3(p.x, -p.y, p.z) : p;
                const Vec3 away = reflect_ray(flat ? Vec3(0, 1, 0) : at.normal, -ray);
                const Vec3 met = start + away * ((-8 - start.z) / away.z);
                const Vec2 expected = 0.5f + Vec2(met.x, met.y) / 24.0f;
                sum += glm::distance(
                    Vec2(image.at(x, y, 0), image.at(x, y, 1)) / reflectance, expected);
                ++tested;
            }
        }
        return sum / tested;
    };
    CHECK(mean_error(1, false) < 0.004);  // a tenth of a meter on the wall
    CHECK(mean_error(0, true) < 0.004);
    CHECK(mean_error(0, false) > 0.012);
}

TEST_CASE_FIXTURE(
    Look, "water reflection: the nearest visible water that requests it has it, once per frame"
              * technique("water.reflection-refraction-maps")) {
    things_above();
    const RenderView view = look({0, 1.6f, 2}, {0, 0.3f, -2});
    Water pool = kMirror;
    pool.size = {3, 3};
    const Entity near = world.create(pool, WorldTransform{at({0, 0.1f, -1})});
    const Entity far = world.create(pool, WorldTransform{at({0, 0.2f, -5})});
    CHECK_FALSE(find_planar_water(world, view).has_value());
    world.add(far, WaterLook{.reflection = WaterReflection::Planar});
    CHECK(find_planar_water(world, view)->entity == far);
    CHECK(find_planar_water(world, view)->level == 0.2f);
    world.add(near, WaterLook{.reflection = WaterReflection::Planar});
    CHECK(find_planar_water(world, view)->entity == near);
    CHECK(draw(view).statistics.water_reflections == 1);
    // From below, and turned away, there is nothing to draw.
    CHECK_FALSE(find_planar_water(world, look({0, -1, 2}, {0, 0.3f, -2})).has_value());
    const RenderView turned_away = look({0, 1.6f, 2}, {0, 1.6f, 9});
    CHECK(draw(turned_away).statistics.water_reflections == 0);
}

TEST_CASE_FIXTURE(
    Look, "water reflection: an authored map is sampled where mirrored rays meet its plane"
              * technique("water.reflection-refraction-maps")) {
    constexpr float kTile = 32;
    constexpr float kHeight = 5;
    world.resource<Environment>() = {
        .sky = SkyKind::Uniform, .zenith = Vec3(1), .horizon = Vec3(1), .ground = Vec3(1)};
    ImageData map;
    map.name = "positions";
    map.width = map.height = 64;
    map.format = PixelFormat::Rgba32F;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const Vec4 color(
                (static_cast<float>(x) + 0.5f) / 64, (static_cast<float>(y) + 0.5f) / 64, 0, 1);
            const auto* bytes = reinterpret_cast<const std::uint8_t*>(&color);
            map.pixels.insert(map.pixels.end(), bytes, bytes + sizeof(color));
        }
    }
    const WaterLook look_of_map = {
        .reflection = WaterReflection::Map,
        .reflection_map = add(std::move(map)),
        .reflection_tile = kTile,
        .reflection_height = kHeight};
    // One copy of the map is at x and z = -16 .. 16.
    const Entity pond = world.create(kMirror, WorldTransform{at({-16, 0, -16})});
    const RenderView view = look({0, 2, 4}, {0, 0, 0}, 64, 64);
    world.add(pond, WaterLook{look_of_map});
    const gpu::FloatImage image = radiance(view);
    for (const IVec2& pixel : {IVec2(32, 40), IVec2(20, 36), IVec2(50, 50), IVec2(10, 60)}) {
        CAPTURE(pixel.x);
        const Vec3 ray = ray_through(view, pixel.x, pixel.y);
        const Vec3 position = Vec3(0, 2, 4) - 2 / ray.y * ray;
        const Vec3 met = position + kHeight / -ray.y * Vec3(ray.x, -ray.y, ray.z);
        const float reflectance = fresnel(-ray.y, kMirror.refractive_index);
        const Vec3 color = rgb_at(image, pixel.x, pixel.y) / reflectance;
        CHECK(color.x * kTile - 16 == test::near(met.x).epsilon(0.02).scale(8));
        CHECK(color.y * kTile - 16 == test::near(met.z).epsilon(0.02).scale(8));
    }
    world.add(pond, WaterLook{.reflection = WaterReflection::Map});  // without a map
    const gpu::FloatImage without = radiance(view);
    world.add(pond, WaterLook{.reflection = WaterReflection::Environment});
    CHECK(radiance(view).pixels == without.pixels);
}

TEST_CASE_FIXTURE(
    Look, "water refraction: a floor map is sampled where refracted rays hit it"
              * technique("water.refraction-map")) {
    constexpr float kTile = 16;
    constexpr float kIndex = 1.33f;
    world.resource<Environment>() = {
        .sky = SkyKind::Uniform, .zenith = Vec3(1), .horizon = Vec3(1), .ground = Vec3(1)};
    ImageData map;
    map.name = "positions";
    map.width = map.height = 64;
    map.format = PixelFormat::Rgba32F;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const Vec4 color(
                (static_cast<float>(x) + 0.5f) / 64, (static_cast<float>(y) + 0.5f) / 64, 0, 1);
            const auto* bytes = reinterpret_cast<const std::uint8_t*>(&color);
            map.pixels.insert(map.pixels.end(), bytes, bytes + sizeof(color));
        }
    }
    const ImageId map_id = add(std::move(map));
    const Water water = {
        .size = {30, 30},
        .depth = 2,
        .refractive_index = kIndex,
        .absorption = Vec3(0),
        .scattering = Vec3(0)};
    const Affine pose = at({-8, 0, -8});  // one copy of the map is at x and z = -8 .. 8
    const Entity pond = world.create(water, WorldTransform{pose});
    const auto show = [&](const RenderView& view) {
        world.add(
            pond,
            WaterLook{
                .refraction = WaterRefraction::Floor, .floor_map = map_id, .floor_tile = kTile});
        const gpu::FloatImage image = radiance(view);
        world.remove<WaterLook>(pond);
        return image;
    };
    // Where a pixel's color says that its ray ended.
    const auto met = [&](const gpu::FloatImage& image, int x, int y, float reflectance) {
        return (rgb_at(image, x, y) - Vec3(reflectance)) / (1 - reflectance) * kTile - 8.0f;
    };
    const RenderView view = look({0, 3, 0}, {0, 0, -1.5f}, 64, 64);
    SUBCASE("flat: straight down it is below, at 30 degrees 0.8114 m further") {
        const gpu::FloatImage image = show(view);
        const gpu::FloatImage depth = aov(view, "depth");
        float worst = 0;
        float at_30 = 0;
        float at_0 = 0;
        float nearest_30 = 1;
        float nearest_0 = 1;
        for (int y = 4; y < 60; ++y) {
            for (int x = 4; x < 60; ++x) {
                const Vec3 ray = ray_through(view, x, y);
                const Vec3 p = point_at(view, depth, x, y);
                const Vec3 bent = refract_ray({0, 1, 0}, -ray, 1 / kIndex);
                const Vec3 expected = p + bent * (2 / -bent.y);
                if (std::max(std::abs(expected.x), std::abs(expected.z)) > 7.5f) {
                    continue;
                }
                const Vec3 found = met(image, x, y, fresnel(-ray.y, kIndex));
                worst = std::max(
                    worst, glm::distance(Vec2(found.x, found.y), Vec2(expected.x, expected.z)));
                const float shift = glm::distance(Vec2(found.x, found.y), Vec2(p.x, p.z));
                const float angle = std::acos(-ray.y);
                if (std::abs(angle - radians(30)) < nearest_30) {
                    nearest_30 = std::abs(angle - radians(30));
                    at_30 = shift;
                }
                if (angle < nearest_0) {
                    nearest_0 = angle;
                    at_0 = shift;
                }
            }
        }
        CHECK(worst < 0.02f);
        CHECK(at_30 == test::near(0.811401).epsilon(0.01));
        CHECK(at_0 < 0.05f);
    }
    SUBCASE("waves: as their normals bend them") {
        WaveTable table;
        fill_wave_table(
            water, {.waves = {{.amplitude = 0.05f, .length = 3, .direction = 0.6f}}}, 2.5, table);
        world.add(pond, table);
        WaterSurface surface;
        surface.frame = water_frame(pose);
        surface.water = water;
        surface.waves = &table;
        const gpu::FloatImage image = show(view);
        const gpu::FloatImage depth = aov(view, "depth");
        double sum = 0;
        int tested = 0;
        for (int y = 10; y < 60; y += 3) {
            for (int x = 4; x < 60; x += 3) {
                const Vec3 ray = ray_through(view, x, y);
                const Vec3 p = point_at(view, depth, x, y);
                const WaterPoint there = sample_water(surface, {p.x, p.z});
                const Vec3 bent = refract_ray(there.normal, -ray, 1 / kIndex);
                const Vec3 expected = p + bent * ((2 + p.y) / -bent.y);
                if (std::max(std::abs(expected.x), std::abs(expected.z)) < 7.5f) {
                    const Vec3 found =
                        met(image, x, y, fresnel(-glm::dot(ray, there.normal), kIndex));
                    sum += glm::distance(Vec2(found.x, found.y), Vec2(expected.x, expected.z));
                    ++tested;
                }
            }
        }
        CHECK(tested > 100);
        CHECK(sum / tested < 0.02);
    }
}

TEST_CASE_FIXTURE(
    Look, "water refraction: shifted, flat water shows the image as it is"
              * technique("water.reflection-refraction-maps")) {
    things_above();
    ball({0, -1, -2}, 0.6f, {0.9f, 0.5f, 0.1f});
    const RenderView view = look({0, 2, 1}, {0, 0, -2});
    const gpu::FloatImage below = radiance(view);
    const Entity pond = pour({.absorption = Vec3(0), .scattering = Vec3(0)});
    world.add(
        pond,
        WaterLook{
            .reflection = WaterReflection::Environment, .refraction = WaterRefraction::Shifted});
    const gpu::FloatImage image = radiance(view);
    const gpu::FloatImage depth = aov(view, "depth");
    for (int y = 34; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const Vec3 ray = ray_through(view, x, y);
            if (std::abs(point_at(view, depth, x, y).y - kLevel) > 1e-3f) {
                continue;
            }
            // The weights of reflection and refraction sum to 1.
            const float reflectance = fresnel(-ray.y, 1.333f);
            for (int c = 0; c < 3; ++c) {
                const float expected = reflectance * 0.5f + (1 - reflectance) * below.at(x, y, c);
                CHECK(std::abs(image.at(x, y, c) - expected) < 0.01f * expected);
            }
        }
    }
}

TEST_CASE_FIXTURE(Look, "water refraction: shifted, the image moves by the tilt of the normals") {
    for (int i = 0; i < 24; ++i) {
        const float fraction = static_cast<float>(i) / 24;
        const Vec3 center(static_cast<float>(i % 6) - 2.5f, -0.7f, -static_cast<float>(i / 6));
        ball(center, 0.45f, {fraction, 1 - fraction, static_cast<float>(i % 2)});
    }
    const RenderView view = look({0, 3, 1}, {0, 0, -1.5f});
    const gpu::FloatImage below = radiance(view);
    const Water water = {.size = {30, 30}, .absorption = Vec3(0), .scattering = Vec3(0)};
    const Entity pond = pour(water);
    WaveTable table;
    fill_wave_table(
        water, {.waves = {{.amplitude = 0.1f, .length = 2, .direction = 0.6f}}}, 2.5, table);
    world.add(pond, table);
    const auto& pose = view.world_from_camera.row;
    const Vec3 right(pose[0].x, pose[1].x, pose[2].x);
    const Vec3 ahead(-pose[0].z, -pose[1].z, -pose[2].z);
    for (const float distortion : {0.0f, 4.0f}) {
        CAPTURE(distortion);
        world.add(
            pond, WaterLook{
                      .reflection = WaterReflection::Environment,
                      .refraction = WaterRefraction::Shifted,
                      .distortion = distortion});
        const gpu::FloatImage image = radiance(view);
        const gpu::FloatImage normals = aov(view, "normal");
        int tested = 0;
        int as_expected = 0;
        int moved = 0;
        for (int y = 8; y < 56; ++y) {
            for (int x = 8; x < 56; ++x) {
                const Vec3 normal = rgb_at(normals, x, y);
                const float reflectance =
                    fresnel(-glm::dot(ray_through(view, x, y), normal), 1.333f);
                // A fiftieth of the image where a normal lies flat.
                const Vec2 lean = {
                    normal.x * right.x + normal.z * right.z,
                    normal.x * ahead.x + normal.z * ahead.z};
                const Vec2 shift = 0.02f * distortion * 64.0f * lean;
                const int from_x = static_cast<int>(static_cast<float>(x) + 0.5f + shift.x);
                const int from_y = static_cast<int>(static_cast<float>(y) + 0.5f - shift.y);
                const Vec3 expected =
                    reflectance * 0.5f + (1 - reflectance) * rgb_at(below, from_x, from_y);
                const float off = glm::distance(rgb_at(image, x, y), expected);
                ++tested;
                as_expected += off < 0.03f ? 1 : 0;
                moved += from_x != x || from_y != y ? 1 : 0;
            }
        }
        CHECK(as_expected > 0.95 * tested);  // at edges rounding may tell pixels apart
        CHECK((moved > tested / 2) == (distortion > 0));
    }
}

TEST_CASE_FIXTURE(
    Look, "water refraction: shifted by any waves, objects above do not appear in the water"
              * technique("water.reflection-refraction-maps")) {
    ball({0, 1.2f, -2}, 0.7f, {0, 90, 0});
    const Water water = {.size = {20, 20}, .absorption = Vec3(0), .scattering = Vec3(0)};
    const Entity pond = pour(water);
    WaveTable table;
    fill_wave_table(
        water, {.waves = {{.amplitude = 0.1f, .length = 1.5f, .direction = 0.6f}}}, 2.5, table);
    world.add(pond, table);
    const RenderView view = look({0, 2, 1}, {0, 0, -2});
    const gpu::FloatImage depth = aov(view, "depth");
    const auto green = [&] {
        const gpu::FloatImage image = radiance(view);
        float most = 0;
        for (int y = 18; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                const bool is_water = std::abs(point_at(view, depth, x, y).y - kLevel) < 0.105f;
                most = is_water ? std::max(most, image.at(x, y, 1)) : most;
            }
        }
        return most;
    };
    world.add(
        pond, WaterLook{
                  .reflection = WaterReflection::Environment,
                  .refraction = WaterRefraction::Shifted,
                  .distortion = 4});
    CHECK(green() < 0.6f);
}

TEST_CASE_FIXTURE(Look, "water look: requested attributes are those of the water") {
    ball({0, -1, -2}, 0.6f, {0.9f, 0.5f, 0.1f});
    const Water water = {.size = {30, 30}};
    const Entity pond = pour(water);
    WaveTable table;
    fill_wave_table(
        water, {.waves = {{.amplitude = 0.1f, .length = 5, .direction = 0.6f}}}, 2.5, table);
    world.add(pond, table);
    WaterSurface surface;
    surface.frame = water_frame(at({0, kLevel, 0}));
    surface.water = water;
    surface.waves = &table;
    const RenderView view = look({0, 2, 1}, {0, 0, -2});
    for (const bool velocity : {false, true}) {
        CAPTURE(velocity);
        FrameRequest request = {.aovs = {"depth", "normal", "albedo"}};
        if (velocity) {
            request.aovs.emplace_back("velocity");
        }
        const FrameOutput out = draw(view, request);
        const auto layer = [&](const std::string& name) {
            const auto found =
                std::find_if(out.aovs.begin(), out.aovs.end(), [&](const AovOutput& a) {
                    return a.name == name;
                });
            REQUIRE(found != out.aovs.end());
            return gpu::read_floats(*found->texture);
        };
        const gpu::FloatImage depth = layer("depth");
        const gpu::FloatImage normal = layer("normal");
        const gpu::FloatImage albedo = layer("albedo");
        double worst = 0;
        for (int y = 34; y < 64; y += 2) {
            for (int x = 0; x < 64; x += 2) {
                const Vec3 p = point_at(view, depth, x, y);
                const WaterPoint there = sample_water(surface, {p.x, p.z});
                worst = std::max<double>(worst, glm::distance(rgb_at(normal, x, y), there.normal));
                CHECK(rgb_at(albedo, x, y) == Vec3(0));
            }
        }
        CHECK(worst < 0.02);
    }
}

}  // namespace limn::test::water_look_test
