#include "bench/oracles/caustic_oracle.h"
#include "ecs/base/optics.h"
#include "ecs/components/caustics.h"
#include "ecs/components/rendering.h"
#include "ecs/components/time.h"
#include "ecs/components/water.h"
#include "render/graph/frame_graph.h"
#include "render/water/caustic_list.h"
#include "systems/water/water_wave_table.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn::test::caustics_mirror_test {
namespace {

constexpr float kHalf = 2;        ///< of the pool [m]
constexpr float kCeiling = 1.5f;  ///< above the water [m]
constexpr int kSide = 256;        ///< of the map [texels]
constexpr float kIndex = 1.333f;

/// Where the sun stands, `angle` above the horizon [rad], over +x turned toward +z.
Vec3 sun_at(float angle, float turn = 0.4f) {
    return {std::cos(angle) * std::cos(turn), std::sin(angle), std::cos(angle) * std::sin(turn)};
}

/// A pool about the origin under a ceiling that the sun shines through, so that only mirrored light
/// is seen on it.
class Grotto : public Scene {
  public:
    Grotto() {
        world.insert_resource(FrameTime{.step = 1.0f / 60, .time = 1});
        world.insert_resource(Exposure{});
        white_ = add(Material{.shading = ShadingModel::Blinn, .base_color = {1, 1, 1, 1}});
        lay({0, kCeiling, 0}, 20);
    }
    Entity fill(const Caustics& caustics) {
        return world.create(
            Water{.size = {2 * kHalf, 2 * kHalf}, .depth = 1, .scattering = Vec3(0)},
            WorldTransform{at({0, 0, 0})}, caustics);
    }
    Entity sun(const Vec3& to_sun) {
        return shine(
            DirectionalLight{.color = {1, 1, 1}, .illuminance = 1}, look_at(to_sun, {0, 0, 0}));
    }
    Entity wave(Entity water) {
        const WaterWaves waves = {
            .waves = {
                {.amplitude = 0.010f, .length = 1.1f, .direction = 0.3f},
                {.amplitude = 0.007f, .length = 0.8f, .direction = 1.9f, .phase = 1},
                {.amplitude = 0.004f, .length = 0.6f, .direction = -1.2f, .phase = 2}}};
        WaveTable table;
        fill_wave_table(world.get<Water>(water), waves, 1.0, table);
        world.add(water, table);
        return water;
    }
    /// Faces down.
    Entity lay(const Vec3& center, float half) {
        return place(
            add(make_square()), white_,
            affine_from(center, glm::angleAxis(radians(90), Vec3(1, 0, 0)), Vec3(half)));
    }
    /// Light at the point of the ceiling straight above `eye`.
    float above(const Vec3& eye) { return rgb_at(radiance(from(eye)), 16, 16).x; }
    [[nodiscard]] RenderView from(const Vec3& eye) const {
        const Affine pose = affine_from(eye, glm::angleAxis(radians(90), Vec3(1, 0, 0)), {1, 1, 1});
        return make_render_view(
            {.fov_y = radians(20.0f), .near = 0.01f}, pose, pose, {.width = 32, .height = 32});
    }

    /// A map as CausticTile and texels, the row of minimum z first.
    struct Map {
        Vec2 corner;
        Vec2 size;
        std::vector<float> texels;
        [[nodiscard]] double at(const glm::dvec2& position) const {
            const double x =
                std::clamp((position.x - corner.x) / size.x * kSide - 0.5, 0.0, kSide - 1.001);
            const double z =
                std::clamp((position.y - corner.y) / size.y * kSide - 0.5, 0.0, kSide - 1.001);
            const auto i = static_cast<std::size_t>(x);
            const auto j = static_cast<std::size_t>(z);
            const double s = x - static_cast<double>(i);
            const double t = z - static_cast<double>(j);
            const auto texel = [&](std::size_t u, std::size_t v) {
                return static_cast<double>(texels[v * kSide + u]);
            };
            return (1 - t) * ((1 - s) * texel(i, j) + s * texel(i + 1, j))
                   + t * ((1 - s) * texel(i, j + 1) + s * texel(i + 1, j + 1));
        }
    };
    /// That of mirrored light: the smaller of two squares of the atlas.
    Map map() {
        draw(from({0, 0.5f, 0}));
        FrameGraph& graph = frame_graph(shared_renderer());
        const gpu::Texture* const texture = graph.texture(graph.find("caustics"));
        REQUIRE(texture != nullptr);
        const gpu::FloatImage image = gpu::read_floats(*texture);
        REQUIRE(image.width == 2 * kSide + kSide);
        Map made;
        // The window that caustic_list.cpp gives it: a fifth of the cells at each side, and a half.
        constexpr int kInner = kSide - 2 * (kSide / 5) - 1;
        made.size = Vec2(2 * kHalf * kSide / kInner);
        made.corner = -0.5f * made.size;
        for (int z = 0; z < kSide; ++z) {
            for (int x = 0; x < kSide; ++x) {
                made.texels.push_back(image.at(2 * kSide + x, image.height - 1 - z, 0));
            }
        }
        return made;
    }

  private:
    MaterialId white_;
};

constexpr Caustics kCaustics = {
    .resolution = 2 * kSide,
    .spacing = 1,
    .mirror_reach = kCeiling + 0.5f,
    .mirror_resolution = kSide};

oracle::CausticSurfaceAt surface_of(const WaveTable& table) {
    return [&table](const glm::dvec2& rest) {
        const WavePoint wave = evaluate_waves(table, Vec2(rest));
        return oracle::CausticSurface{
            glm::dvec3(rest.x, 0, rest.y) + glm::dvec3(wave.offset),
            glm::cross(
                glm::dvec3(0, 0, 1) + glm::dvec3(wave.by_z),
                glm::dvec3(1, 0, 0) + glm::dvec3(wave.by_x))};
    };
}

}  // namespace

TEST_CASE_FIXTURE(
    Grotto, "caustics: flat water reflects the sun evenly onto a ceiling, by Fresnel's law"
                * technique("caustic.projected-vertices")) {
    fill(kCaustics);
    for (const float height : {70.0f, 35.0f}) {
        const Vec3 to_sun = sun_at(radians(height));
        const Entity light = sun(to_sun);
        const Vec2 aside = reflected_slope(to_sun) * kCeiling;
        CHECK(glm::dot(aside, Vec2(to_sun.x, to_sun.z)) < 0);  // away from the sun
        const float expected = fresnel(to_sun.y, kIndex) * to_sun.y / kPi;
        for (const Vec2 entry : {Vec2(0, 0), Vec2(1.8f, -1.8f), Vec2(-1.8f, 0.4f)}) {
            CAPTURE(entry.x);
            CHECK(
                above({entry.x + aside.x, 0.2f, entry.y + aside.y}) / expected
                == test::near(1).epsilon(0.005));
        }
        for (const Vec2 beside : {Vec2(2.2f, 0), Vec2(0, -2.2f)}) {
            CHECK(above({beside.x + aside.x, 0.2f, beside.y + aside.y}) == 0);
        }
        world.destroy(light);
    }
}

TEST_CASE_FIXTURE(
    Grotto, "caustics: all light that waves reflect arrives above, within 1 %"
                * technique("caustic.projected-vertices")) {
    const Entity water = wave(fill(kCaustics));
    for (const float height : {65.0f, 40.0f}) {
        const Vec3 to_sun = sun_at(radians(height));
        const Entity light = sun(to_sun);
        const Map found = map();
        const oracle::CausticLight traced = oracle::trace_mirrored_photons(
            {.half = glm::dvec2(kHalf), .boxes = {}}, surface_of(world.get<WaveTable>(water)),
            glm::dvec3(to_sun), kCeiling, glm::dvec2(0), 64, 90000);
        double sum = 0;
        for (const float texel : found.texels) {
            sum += static_cast<double>(texel);
        }
        sum *= static_cast<double>(found.size.x) * found.size.y / (kSide * kSide);
        CHECK(sum / traced.entered == test::near(1).epsilon(0.005));
        world.destroy(light);
    }
}

TEST_CASE_FIXTURE(
    Grotto, "caustics: light reflected by waves onto a ceiling matches traced photons"
                * technique("caustic.projected-vertices")) {
    const Entity water = wave(fill(kCaustics));
    const Vec3 to_sun = sun_at(radians(60));
    sun(to_sun);
    constexpr int kCells = 32;
    const glm::dvec2 aside = glm::dvec2(reflected_slope(to_sun)) * static_cast<double>(kCeiling);
    const oracle::CausticLight traced = oracle::trace_mirrored_photons(
        {.half = glm::dvec2(kHalf), .boxes = {}}, surface_of(world.get<WaveTable>(water)),
        glm::dvec3(to_sun), kCeiling, aside, kCells, 1000000);
    const Map found = map();
    double error = 0;
    double all = 0;
    double contrast = 0;
    for (int z = 0; z < kCells; ++z) {
        for (int x = 0; x < kCells; ++x) {
            double here = 0;
            constexpr int kPoints = 8;
            for (int p = 0; p < kPoints * kPoints; ++p) {
                const glm::dvec2 part((p % kPoints + 0.5) / kPoints, (p / kPoints + 0.5) / kPoints);
                here +=
                    found.at((glm::dvec2(x, z) + part) * (2.0 * kHalf / kCells) - glm::dvec2(kHalf))
                    / (kPoints * kPoints);
            }
            error += std::abs(here - traced.at(x, z));
            contrast += std::abs(traced.at(x, z) - 1);
            all += traced.at(x, z);
        }
    }
    CHECK(contrast / all > 0.3);
    CHECK(error / all < 0.05);
}

TEST_CASE_FIXTURE(
    Grotto, "caustics: an object above the water occludes its reflected light"
                * technique("caustic.projected-vertices")) {
    fill(kCaustics);
    const Vec3 to_sun = sun_at(radians(60), 0);
    sun(to_sun);
    const float hangs = 0.75f;
    const Vec2 entry(0.3f, 0.2f);
    const Vec2 slant = reflected_slope(to_sun);
    const Vec2 hit = entry + slant * hangs;
    const Vec2 behind = entry + slant * kCeiling;
    const float open = above({behind.x, 1.2f, behind.y});
    CHECK(open > 0);
    lay({hit.x, hangs, hit.y}, 0.2f);
    CHECK(above({behind.x, 1.2f, behind.y}) == 0);
    CHECK(above({hit.x, 0.5f, hit.y}) / open == test::near(1).epsilon(0.01));
    for (const float x : {-0.35f, 0.35f}) {
        CHECK(above({behind.x + x, 1.2f, behind.y}) / open == test::near(1).epsilon(0.01));
    }
}

TEST_CASE_FIXTURE(
    Grotto, "caustics: a wall receives reflected light, the same with every light method"
                * technique("caustic.projected-vertices")) {
    fill(kCaustics);
    const Vec3 to_sun = sun_at(radians(45), 0);
    sun(to_sun);
    // Toward +x, at x = -2.5: light goes as far along -x as up.
    place(
        add(make_square()),
        add(Material{.shading = ShadingModel::Blinn, .base_color = {1, 1, 1, 1}}),
        affine_from({-2.5f, 0.7f, 0}, glm::angleAxis(radians(90), Vec3(0, 1, 0)), Vec3(0.5f)));
    const Affine pose = look_at({-1.5f, 0.7f, 0}, {-2.5f, 0.7f, 0});
    const RenderView view = make_render_view(
        {.fov_y = radians(20.0f), .near = 0.01f}, pose, pose, {.width = 32, .height = 32});
    world.insert_resource(Rendering{});
    const float direct = to_sun.x / kPi;
    const float expected = direct * (1 + fresnel(to_sun.y, kIndex));
    for (const LightMethod method :
         {LightMethod::Clustered, LightMethod::FullScreen, LightMethod::ObjectMajor,
          LightMethod::LightMajor}) {
        world.resource<Rendering>().lights = method;
        CHECK(rgb_at(radiance(view), 16, 16).x / expected == test::near(1).epsilon(0.003));
    }
}

TEST_CASE_FIXTURE(
    Grotto, "caustics: no light is reflected above mirror_reach, and there is no map if it is 0") {
    const Entity water = fill({.resolution = 64});
    const Vec3 to_sun = sun_at(radians(60));
    sun(to_sun);
    const Vec2 aside = reflected_slope(to_sun) * kCeiling;
    CHECK(above({aside.x, 0.2f, aside.y}) == 0);
    FrameGraph& graph = frame_graph(shared_renderer());
    CHECK(!graph.was_run("caustic rays"));  // nor does anybody look into the water
    world.get<Caustics>(water).mirror_reach = kCeiling - 0.1f;
    CHECK(above({aside.x, 0.2f, aside.y}) == 0);
    CHECK(graph.was_run("caustic rays"));
    world.get<Caustics>(water).mirror_reach = kCeiling + 0.1f;
    CHECK(above({aside.x, 0.2f, aside.y}) > 0);
}

}  // namespace limn::test::caustics_mirror_test
