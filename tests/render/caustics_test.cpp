#include "bench/oracles/caustic_oracle.h"
#include "ecs/base/caustic_optics.h"
#include "ecs/base/optics.h"
#include "ecs/components/caustics.h"
#include "ecs/components/mirror_caustic.h"
#include "ecs/components/shadow.h"
#include "ecs/components/time.h"
#include "ecs/components/water.h"
#include "render/gpu/buffer.h"
#include "render/gpu/buffer_texture.h"
#include "render/gpu/shader_library.h"
#include "render/graph/frame_graph.h"
#include "render/shaders/caustics_gpu.h"
#include "render/water/caustic_splat.h"
#include "systems/water/water_ripple_field.h"
#include "systems/water/water_wave_table.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace limn::test::caustics_test {
namespace {

constexpr float kHalf = 2;       ///< of the pool [m]
constexpr float kDepth = 1.5f;   ///< [m]
constexpr float kClear = 1e-4f;  ///< [1/m]

/// Where the sun stands, `angle` above the horizon [rad], over +x turned toward +z.
Vec3 sun_at(float angle, float turn = 0.4f) {
    return {std::cos(angle) * std::cos(turn), std::sin(angle), std::cos(angle) * std::sin(turn)};
}

/// A pool about the origin with a floor and nothing around it.
class Pool : public Scene {
  public:
    Pool() {
        world.insert_resource(FrameTime{.step = 1.0f / 60, .time = 1});
        world.insert_resource(Exposure{});
        const MaterialId white =
            add(Material{.shading = ShadingModel::Blinn, .base_color = {1, 1, 1, 1}});
        floor_ = place(
            add(make_square()), white,
            affine_from({0, -kDepth, 0}, glm::angleAxis(radians(-90), Vec3(1, 0, 0)), {4, 4, 4}));
        white_ = white;
    }

    Entity fill(const Caustics& caustics) {
        return world.create(
            Water{
                .size = {2 * kHalf, 2 * kHalf},
                .depth = kDepth,
                .absorption = Vec3(kClear),
                .scattering = Vec3(0)},
            WorldTransform{at({0, 0, 0})}, caustics);
    }
    Entity sun(const Vec3& to_sun) {
        return shine(
            DirectionalLight{.color = {1, 1, 1}, .illuminance = 1}, look_at(to_sun, {0, 0, 0}));
    }
    Entity wave(Entity water, const WaterWaves& waves) {
        WaveTable table;
        fill_wave_table(world.get<Water>(water), waves, 1.0, table);
        world.add(water, table);
        return water;
    }
    Entity block(const Vec3& center, float half) {
        return place(
            add(make_square()), white_,
            affine_from(center, glm::angleAxis(radians(-90), Vec3(1, 0, 0)), Vec3(half)));
    }

    /// The map of the first water; rows run along z.
    gpu::FloatImage map(const Vec3& eye = {0, -0.1f, 0}) {
        draw(from_below(eye));
        FrameGraph& graph = frame_graph(shared_renderer());
        const gpu::Texture* const texture = graph.texture(graph.find("caustics"));
        REQUIRE(texture != nullptr);
        gpu::FloatImage image = gpu::read_floats(*texture);
        gpu::FloatImage turned = image;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                turned.pixels[static_cast<std::size_t>(y * image.width + x)] =
                    image.at(x, image.height - 1 - y, 0);
            }
        }
        return turned;
    }
    /// From just below the surface straight down: +x is right, +z is down.
    [[nodiscard]] RenderView from_below(const Vec3& eye = {0, -0.1f, 0}) const {
        const Affine pose =
            affine_from(eye, glm::angleAxis(radians(-90), Vec3(1, 0, 0)), {1, 1, 1});
        return make_render_view(
            {.fov_y = radians(90.0f), .near = 0.01f}, pose, pose, {.width = 96, .height = 96});
    }

  private:
    Entity floor_;
    MaterialId white_;
};

WaterWaves some_waves() {
    return {
        .waves = {
            {.amplitude = 0.02f, .length = 1.1f, .direction = 0.3f},
            {.amplitude = 0.015f, .length = 0.8f, .direction = 1.9f, .phase = 1},
            {.amplitude = 0.01f, .length = 0.6f, .direction = -1.2f, .phase = 2}}};
}

oracle::CausticSurfaceAt surface_of(const WaveTable& table) {
    return [&table](const glm::dvec2& rest) {
        const WavePoint wave = evaluate_waves(table, Vec2(rest));
        const glm::dvec3 by_x = glm::dvec3(1, 0, 0) + glm::dvec3(wave.by_x);
        const glm::dvec3 by_z = glm::dvec3(0, 0, 1) + glm::dvec3(wave.by_z);
        return oracle::CausticSurface{
            glm::dvec3(rest.x, 0, rest.y) + glm::dvec3(wave.offset), glm::cross(by_z, by_x)};
    };
}

/// Texel of a position in the window, which is 3 % wider on both sides than the pool.
double texel_of(double position, int side) {
    const double size = 2 * static_cast<double>(kHalf) * 1.06;
    return (position / size + 0.5) * side;
}

/// Mean of the map over the part of the floor from `low` to `high`.
double mean_on_floor(
    const gpu::FloatImage& map, const Vec2& slant, const glm::dvec2& low, const glm::dvec2& high) {
    const glm::dvec2 moved = glm::dvec2(slant) * static_cast<double>(kDepth);
    double sum = 0;
    int count = 0;
    constexpr int kPoints = 12;
    for (int j = 0; j < kPoints; ++j) {
        for (int i = 0; i < kPoints; ++i) {
            const glm::dvec2 at =
                low + (high - low) * glm::dvec2((i + 0.5) / kPoints, (j + 0.5) / kPoints) - moved;
            const double x = texel_of(at.x, map.width) - 0.5;
            const double z = texel_of(at.y, map.width) - 0.5;
            const int a = static_cast<int>(std::floor(x));
            const int b = static_cast<int>(std::floor(z));
            const double s = x - a;
            const double t = z - b;
            const auto value = [&](int u, int v) {
                return static_cast<double>(
                    map.at(std::clamp(u, 0, map.width - 1), std::clamp(v, 0, map.width - 1), 0));
            };
            sum += (1 - t) * ((1 - s) * value(a, b) + s * value(a + 1, b))
                   + t * ((1 - s) * value(a, b + 1) + s * value(a + 1, b + 1));
            ++count;
        }
    }
    return sum / count;
}

Vec2 slant_of(const Vec3& to_sun, float index) {
    const Vec3 ray = refract_ray({0, 1, 0}, to_sun, 1 / index);
    return Vec2(ray.x, ray.z) / -ray.y;
}

}  // namespace

TEST_CASE_FIXTURE(
    Pool, "caustics: under flat water light is even within 0.5 %, at any sun elevation"
              * technique("caustic.projected-vertices")) {
    const Entity water = fill({.resolution = 128});
    Entity light = sun(sun_at(radians(80)));
    for (const float height : {80.0f, 50.0f, 15.0f}) {
        world.destroy(light);
        light = sun(sun_at(radians(height)));
        for (const int spacing : {1, 2, 4}) {
            world.get<Caustics>(water).spacing = spacing;
            const gpu::FloatImage found = map();
            REQUIRE(found.width == 128);
            float least = 2;
            float most = 0;
            for (int z = 1; z < 127; ++z) {
                for (int x = 1; x < 127; ++x) {
                    least = std::min(least, found.at(x, z, 0));
                    most = std::max(most, found.at(x, z, 0));
                }
            }
            CAPTURE(height);
            CAPTURE(spacing);
            CHECK(least > 0.995f);
            CHECK(most < 1.005f);
        }
    }
}

TEST_CASE_FIXTURE(
    Pool, "caustics: the floor below flat water is lit by the laws of Fresnel and Snell"
              * technique("caustic.projected-vertices")) {
    const float absorption = 0.3f;
    const Entity water = fill({.resolution = 64});
    world.get<Water>(water).absorption = {absorption, 0.0f, 0.0f};
    const Vec3 to_sun = sun_at(radians(40));
    sun(to_sun);
    const Vec3 ray = refract_ray({0, 1, 0}, to_sun, 1 / 1.333f);
    const float through = (1 - fresnel(to_sun.y, 1.333f)) * to_sun.y / kPi;
    const float left = std::exp(absorption * kDepth / ray.y);
    const float veil = std::exp(-absorption * (kDepth - 0.1f));  // from the floor to the camera
    for (const bool simulated : {true, false}) {
        if (!simulated) {
            world.remove<Caustics>(water);
        }
        const Vec3 color = rgb_at(radiance(from_below()), 48, 48);
        CHECK(color.y == test::near(through).epsilon(0.01));
        CHECK(color.x == test::near(through * left * veil).epsilon(0.005));
    }
    world.destroy(water);
    CHECK(rgb_at(radiance(from_below()), 48, 48).x == test::near(to_sun.y / kPi).epsilon(0.005));
}

TEST_CASE_FIXTURE(
    Pool, "caustics: all light that waves refract arrives, within 1 %"
              * technique("caustic.projected-vertices")) {
    const Entity water = wave(fill({.resolution = 256}), some_waves());
    const Vec3 to_sun = sun_at(radians(60));
    sun(to_sun);
    const gpu::FloatImage found = map();
    // The window is wider than the pool; photons are let in by all of it.
    oracle::CausticPool pool = {.half = glm::dvec2(1.06 * kHalf), .depth = kDepth, .boxes = {}};
    const oracle::CausticLight traced = oracle::trace_photons(
        pool, surface_of(world.get<WaveTable>(water)), glm::dvec3(to_sun), 64, 90000);
    CHECK(traced.received() == test::near(traced.entered).epsilon(1e-9));
    double sum = 0;
    for (const float texel : found.pixels) {
        sum += static_cast<double>(texel);
    }
    sum *= std::pow(2 * 1.06 * kHalf / found.width, 2);
    CHECK(sum == test::near(traced.entered).epsilon(0.01));
}

TEST_CASE_FIXTURE(
    Pool, "caustics: they match traced photons, more closely on a finer grid"
              * technique("caustic.projected-vertices")) {
    const Entity water = wave(fill({.resolution = 256}), some_waves());
    const Vec3 to_sun = sun_at(radians(60));
    sun(to_sun);
    const Vec2 slant = slant_of(to_sun, 1.333f);
    constexpr int kCells = 40;
    const oracle::CausticLight traced = oracle::trace_photons(
        {.half = glm::dvec2(kHalf), .depth = kDepth, .boxes = {}},
        surface_of(world.get<WaveTable>(water)), glm::dvec3(to_sun), kCells, 1500000);
    double before = 1;
    for (const int spacing : {8, 4, 2}) {
        world.get<Caustics>(water).spacing = spacing;
        const gpu::FloatImage found = map();
        double error = 0;
        double all = 0;
        double contrast = 0;
        for (int z = 4; z < kCells - 14; ++z) {
            for (int x = 4; x < kCells - 14; ++x) {
                const glm::dvec2 low =
                    glm::dvec2(x, z) * (2.0 * kHalf / kCells) - glm::dvec2(kHalf);
                const double here =
                    mean_on_floor(found, slant, low, low + glm::dvec2(2.0 * kHalf / kCells));
                error += std::abs(here - traced.at(x, z));
                contrast += std::abs(traced.at(x, z) - 1);
                all += traced.at(x, z);
            }
        }
        CAPTURE(spacing);
        CHECK(contrast / all > 0.3);
        CHECK(error / all < before);
        before = error / all;
    }
    CHECK(before < 0.04);
}

TEST_CASE_FIXTURE(
    Pool,
    "caustics: a moving ripple takes its caustic along" * technique("caustic.projected-vertices")) {
    const Entity water = fill({.resolution = 256});
    sun(sun_at(radians(89)));
    const WaterRipples ripples = {.cell = 0.05f};
    int before = -1;
    for (const int shift : {-20, 20}) {
        RippleState state = make_ripples(world.get<Water>(water), ripples, 1.0f / 60);
        for (int z = 0; z < state.cells.y; ++z) {
            for (int x = 0; x < state.cells.x; ++x) {
                const float u = static_cast<float>(x - state.cells.x / 2 - shift) * state.cell;
                const float v = static_cast<float>(z - state.cells.y / 2) * state.cell;
                state.height[state.at(x, z)] = 0.03f * std::exp(-(u * u + v * v) / 0.08f);
            }
        }
        state.previous = state.height;
        if (world.has<RippleState>(water)) {
            world.get<RippleState>(water) = state;
        } else {
            world.add(water, state);
        }
        const gpu::FloatImage found = map();
        const auto most = std::max_element(found.pixels.begin(), found.pixels.end());
        const int x = static_cast<int>(most - found.pixels.begin()) % 256;
        CHECK(*most > 1.5f);
        CHECK(std::abs(x - texel_of(shift * 0.05, 256)) < 6);
        CHECK(x != before);
        before = x;
    }
}

TEST_CASE_FIXTURE(
    Pool, "caustics: an object in the water shadows the refracted light"
              * technique("caustic.projected-vertices")) {
    fill({.resolution = 256});
    const Vec3 to_sun = sun_at(radians(45), 0);
    sun(to_sun);
    block({0, -0.75f, 0}, 0.2f);
    // Its shadow is offset by the horizontal distance of the refracted ray below it.
    const float aside = slant_of(to_sun, 1.333f).x * (kDepth - 0.75f);
    const auto floor_at = [&](float x) {
        return rgb_at(radiance(from_below({x, -1.2f, 0})), 48, 48).x;
    };
    CHECK(aside < -0.3f);
    CHECK(floor_at(aside) < 1e-3f);
    CHECK(floor_at(aside - 0.15f) < 1e-3f);
    CHECK(floor_at(aside - 0.28f) > 0.1f);
    CHECK(floor_at(aside + 0.28f) > 0.1f);
}

TEST_CASE_FIXTURE(
    Pool, "caustics: an object above the water shadows the floor below"
              * technique("caustic.projected-vertices")) {
    fill({.resolution = 256});
    const Vec3 to_sun = sun_at(radians(45), 0);
    world.add(sun(to_sun), Shadow{.resolution = 1024, .cascades = 1, .distance = 10});
    block({0.5f, 0.5f, 0}, 0.3f);
    const float entry = 0.5f - 0.5f;  // the sun stands 45 degrees high
    const float aside = slant_of(to_sun, 1.333f).x * kDepth;
    const auto floor_at = [&](float x) {
        return rgb_at(radiance(from_below({x, -1.2f, 0})), 48, 48).x;
    };
    CHECK(floor_at(entry + aside) < 2e-3f);
    CHECK(floor_at(entry + aside + 0.5f) > 0.1f);
    CHECK(floor_at(entry + aside - 0.5f) > 0.1f);
}

TEST_CASE_FIXTURE(
    Pool, "caustics: strength 0 equals flat water, and is bit-identical when repeated") {
    const Entity water = wave(fill({.resolution = 128, .strength = 0}), some_waves());
    const Vec3 to_sun = sun_at(radians(60));
    sun(to_sun);
    const gpu::FloatImage flat = radiance(from_below());
    const float through = (1 - fresnel(to_sun.y, 1.333f)) * to_sun.y / kPi;
    for (const int x : {10, 48, 80}) {
        CHECK(flat.at(x, 40, 0) == test::near(through).epsilon(0.02));
    }
    world.get<Caustics>(water).strength = 1;
    const gpu::FloatImage first = map();
    CHECK(largest_difference(first, map()) == 0);
}

TEST_CASE_FIXTURE(
    Pool, "caustics: the book's method is as bright as the cube of the water's height"
              * technique("caustic.refraction-pool")) {
    const Entity water = fill({.method = CausticMethod::Pool, .resolution = 256});
    world.get<Water>(water).depth = 0.01f;  // where it lands is where it comes from
    sun(sun_at(radians(89.9f)));
    const gpu::FloatImage still = map({0, 0.5f, 0});
    CHECK(*std::max_element(still.pixels.begin(), still.pixels.end()) == 0);
    const float amplitude = 0.01f;  // so flat that it hardly bends light aside
    wave(water, {.waves = {{.amplitude = amplitude, .length = 1.7f, .direction = 0.5f}}});
    const gpu::FloatImage found = map({0, 0.5f, 0});
    const auto place_of = [](int texel) {
        return static_cast<float>(((texel + 0.5) / 256 - 0.5) * 2.12) * kHalf;
    };
    float darkest = 1;
    float brightest = 0;
    for (int row = 25; row < 236; row += 30) {
        for (int i = 20; i < 236; i += 9) {
            const Vec2 at(place_of(i), place_of(row));
            const float height = evaluate_waves(world.get<WaveTable>(water), at).offset.y;
            const float fraction = 0.5f + 0.5f * height / amplitude;
            const float light = fraction * fraction * fraction;
            CHECK(std::abs(found.at(i, row, 0) - light) < 0.005f);
            darkest = std::min(darkest, light);
            brightest = std::max(brightest, light);
        }
    }
    CHECK(darkest < 0.01f);
    CHECK(brightest > 0.99f);
}

TEST_CASE_FIXTURE(
    RenderTest, "caustics: the GPU sums light as the CPU does, to the rounding of a texel"
                    * technique("caustic.projected-vertices")) {
    constexpr int kCells = 16;
    constexpr int kSide = 32;
    layout::CausticRecord record{};
    record.grid = {kCells, kSide, 0, 0};
    record.wires.x = 3;
    constexpr int kWidth = 64;
    record.target = {kSide, 0, 0, 1};
    std::vector<Vec4> rays;
    for (int z = 0; z <= kCells; ++z) {
        for (int x = 0; x <= kCells; ++x) {
            const auto u = static_cast<float>(2 * x);
            const auto v = static_cast<float>(2 * z);
            // Some fold over, and some land beside the map.
            rays.emplace_back(
                u + 3 * std::sin(0.7f * v), v + 4 * std::sin(0.5f * u), 1 + 0.3f * std::sin(v), 0);
        }
    }
    CausticSums sums;
    std::vector<float> expected(kWidth * kSide);
    splat_caustics(std::span(&record, 1), rays, kWidth, sums, expected);

    const Result<const gpu::Program*> splat =
        device().shaders().load({.compute = "caustics_splat.comp"});
    REQUIRE(splat.ok());
    std::vector<Vec4> jobs;
    for (std::size_t first = 0; first < rays.size(); first += layout::kRayGroup) {
        jobs.emplace_back(0, static_cast<float>(first), 0, 0);
    }
    const std::size_t groups = jobs.size();
    jobs.resize(groups + layout::kCausticTexels);
    std::memcpy(jobs.data() + groups, &record, sizeof(record));
    const gpu::Buffer records = gpu::Buffer::of<Vec4>("jobs", jobs);
    BufferTexture texels("jobs", GL_RGBA32F);
    texels.set(records);
    const gpu::Buffer landed = gpu::Buffer::of<Vec4>("rays", rays);
    const std::vector<std::uint32_t> none(kWidth * kSide);
    const gpu::Buffer light("light", none.size() * 4, gpu::BufferUse::Dynamic, none.data());
    device().use(**splat);
    (*splat)->set("groups", static_cast<int>(groups));
    (*splat)->set("width", kWidth);
    texels.bind(device(), layout::kCausticRecordsUnit);
    device().bind_storage(layout::kCausticRaysBinding, landed);
    device().bind_storage(layout::kCausticLightBinding, light);
    device().dispatch(static_cast<unsigned>(groups));
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    std::vector<std::uint32_t> found(none.size());
    light.read(0, std::as_writable_bytes(std::span(found)));
    for (std::size_t i = 0; i < found.size(); ++i) {
        CHECK(static_cast<float>(found[i]) / 524288 == test::near(expected[i]).epsilon(2e-3));
    }
}

TEST_CASE("caustics: wires are lines of light from ray to ray, every n-th of the grid") {
    constexpr int kCells = 16;
    constexpr int kSide = 64;
    layout::CausticRecord record{};
    record.grid = {kCells, kSide, 0, 0};
    record.target = {0, 0, 0, 1};
    std::vector<Vec4> rays;
    for (int z = 0; z <= kCells; ++z) {
        for (int x = 0; x <= kCells; ++x) {  // moved aside by half a texel
            constexpr float kFaint = 1e-9f;  // less than the sums hold
            rays.emplace_back(Vec4(4 * x, 4 * z, kFaint, 0) + Vec4(0.5f, 0.5f, 0, 0));
        }
    }
    const auto summed = [&](float wires) {
        record.wires.x = wires;
        CausticSums sums;
        std::vector<float> atlas(kSide * kSide);
        splat_caustics(std::span(&record, 1), rays, kSide, sums, atlas);
        return atlas;
    };
    const std::vector<float> none = summed(0);
    CHECK(std::all_of(none.begin(), none.end(), [](float x) { return x == 0; }));
    const std::vector<float> light = summed(4);
    for (int z = 1; z < kSide - 1; ++z) {
        for (int x = 1; x < kSide - 1; ++x) {
            const bool on_row = z % 16 == 0;
            const bool on_column = x % 16 == 0;
            if (on_row != on_column) {
                CHECK(light[z * kSide + x] == test::near(4).epsilon(0.3));
            } else if (!on_row && std::min(z % 16, x % 16) > 1 && std::max(z % 16, x % 16) < 15) {
                CHECK(light[z * kSide + x] == 0);
            }
        }
    }
    double sum = 0;
    for (const float x : light) {
        sum += static_cast<double>(x);
    }
    // Four lines each way of 64 texels, less the half texel that is beyond the border.
    CHECK(sum == test::near(4 * 2 * 4 * 63.5).epsilon(0.02));
    for (Vec4& ray : rays) {
        ray.z = 0;  // in the shadow, or beside the water
    }
    CHECK(summed(4) == none);
}

TEST_CASE_FIXTURE(
    Pool, "caustics: wires show where a mirror's vertices are moved to"
              * technique("caustic.reflection-plane")) {
    const float floor_height = -kDepth;
    const Entity mirror = place(
        add(make_square()), add(Material{.shading = ShadingModel::Unlit, .base_color = Vec4(0)}),
        affine_from(
            {1, floor_height + 1, 0}, glm::angleAxis(radians(-90), Vec3(0, 1, 0)), Vec3(0.2f)));
    sun(glm::normalize(Vec3(-1, 1, 0)));
    const RenderView view = from_below({0, floor_height + 0.5f, 0});
    world.add(mirror, MirrorCaustic{.offset = floor_height});
    const gpu::FloatImage without = radiance(view);
    world.get<MirrorCaustic>(mirror).wires = 5;
    const gpu::FloatImage with = radiance(view);
    // The square lands as one of a side of 0.4 m about the origin, 48 px a 0.5 m.
    int edges = 0;
    for (int j = 0; j < with.height; ++j) {
        for (int i = 0; i < with.width; ++i) {
            const float added = with.at(i, j, 0) - without.at(i, j, 0);
            const Vec2 from = glm::abs(Vec2(i - 48, j - 48)) * (0.5f / 48);
            const float apart = std::abs(std::max(from.x, from.y) - 0.2f);
            const float diagonal = std::abs(from.x - from.y);
            CHECK((added == 0 || std::abs(added - 5) < 0.01f || added > 9));
            CHECK((added == 0 || apart < 0.03f || diagonal < 0.03f));
            edges += added > 0 && apart < 0.03f ? 1 : 0;
        }
    }
    CHECK(edges > 100);
}

TEST_CASE_FIXTURE(
    Pool, "caustics: a mirror reflects the sun onto the points of the book, and nowhere else"
              * technique("caustic.reflection-plane")) {
    // Upright at x = 1, a meter above the plane, turned toward -x; the sun comes down along (1,
    // -1).
    const float floor_height = -kDepth;
    const MeshId square = add(make_square());
    const MaterialId black =
        add(Material{.shading = ShadingModel::Unlit, .base_color = {0, 0, 0, 1}});
    const Entity mirror = place(
        square, black,
        affine_from(
            {1, floor_height + 1, 0}, glm::angleAxis(radians(-90), Vec3(0, 1, 0)), Vec3(0.2f)));
    sun(glm::normalize(Vec3(-1, 1, 0)));
    const RenderView view = from_below({0, floor_height + 0.5f, 0});
    const gpu::FloatImage without = radiance(view);
    world.add(mirror, MirrorCaustic{.offset = floor_height});
    const gpu::FloatImage with = radiance(view);
    const auto added = [&](float x, float z) {
        const int i = static_cast<int>(48 + 48 * x / 0.5f);
        const int j = static_cast<int>(48 + 48 * z / 0.5f);
        return with.at(i, j, 0) - without.at(i, j, 0);
    };
    CHECK(added(0, 0) == test::near(0.125).epsilon(1e-3));
    CHECK(added(0.17f, -0.17f) == test::near(0.125).epsilon(1e-3));
    for (const float out : {-0.23f, 0.23f}) {
        CHECK(added(out, 0) == 0);
        CHECK(added(0, out) == 0);
    }
    world.get<MirrorCaustic>(mirror).strength = std::numeric_limits<float>::quiet_NaN();
    CHECK(largest_difference(without, radiance(view)) == 0);
}

TEST_CASE_FIXTURE(Pool, "caustics: without the component there is no map and no pass") {
    sun(sun_at(radians(60)));
    draw(from_below());
    CHECK(!frame_graph(shared_renderer()).was_run("caustic rays"));
    const Entity water = fill({.resolution = 64});
    draw(from_below());
    CHECK(frame_graph(shared_renderer()).was_run("caustic rays"));
    world.remove<Caustics>(water);
    draw(from_below());
    CHECK(!frame_graph(shared_renderer()).was_run("caustic rays"));
}

TEST_CASE_FIXTURE(Pool, "caustics: NaN and infinite settings give an image") {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const Entity water = wave(
        fill(
            {.resolution = -7,
             .spacing = 0,
             .strength = kNan,
             .reach = -1,
             .window = INFINITY,
             .cascades = -3,
             .shaft_steps = -1,
             .mirror_reach = INFINITY,
             .mirror_resolution = 0}),
        some_waves());
    const auto all_finite = [&] {
        const gpu::FloatImage image = radiance(from_below());
        return std::all_of(image.pixels.begin(), image.pixels.end(), [](float x) {
            return std::isfinite(x) && x >= 0;
        });
    };
    const Entity light = sun(sun_at(radians(30)));
    CHECK(all_finite());
    world.get<Caustics>(water).mirror_reach = 1e30f;
    world.get<Caustics>(water).shaft_steps = 1 << 30;
    world.get<Caustics>(water).cascades = 1000;
    CHECK(all_finite());
    world.get<Water>(water).size = {0, 0};
    CHECK(all_finite());
    world.get<Water>(water).depth = 0;
    CHECK(all_finite());
    for (const float height : {0.0f, -30.0f, 90.0f}) {
        world.get<WorldTransform>(light).world = look_at(sun_at(radians(height), 0.01f), {0, 0, 0});
        CHECK(all_finite());
    }
}

}  // namespace limn::test::caustics_test
