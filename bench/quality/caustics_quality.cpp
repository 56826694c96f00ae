#include "bench/oracles/caustic_oracle.h"
#include "bench/quality/quality_scene.h"
#include "ecs/base/optics.h"
#include "ecs/components/caustics.h"
#include "ecs/components/light.h"
#include "ecs/components/time.h"
#include "ecs/components/water.h"
#include "render/render_frame.h"
#include "systems/water/water_ripple_field.h"
#include "systems/water/water_wave_table.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace limn::caustics_quality {
namespace {

constexpr float kHalf = 2;      ///< half extent of the pool [m]
constexpr float kDepth = 1.5f;  ///< [m]
constexpr double kRim = 1.06;   ///< size of a map relative to its water
constexpr int kCells = 64;      ///< cells of the floor that are compared, along a side
constexpr int kNearWalls = 16;  ///< excluded margin: cells that lose light to the walls
constexpr long kPhotons = 10'000'000;

/// A pool with a floor, lit by the sun.
class Pool {
  public:
    Pool(HeadlessRenderer& headless, const Vec3& to_sun) : headless_(headless), to_sun_(to_sun) {
        World& world = scene_.world;
        world.insert_resource(FrameTime{.step = 1.0f / 60, .time = 1});
        white_ = scene_.add(
            {.shading = ShadingModel::Blinn, .base_color = {1, 1, 1, 1}, .specular = Vec3(0)});
        square_ = scene_.add(quality_square());
        add_plate({0, -kDepth, 0}, 2 * kHalf);
        scene_.add_light(DirectionalLight{.illuminance = 1}, look_at(to_sun, {0, 0, 0}));
        water_ = world.create(
            Water{
                .size = Vec2(2 * kHalf),
                .depth = kDepth,
                .absorption = Vec3(1e-6f),
                .scattering = Vec3(0)},
            Caustics{}, WorldTransform{placed_at({0, 0, 0})});
    }

    void add_plate(const Vec3& center, float half) {
        const Affine flat =
            affine_from(center, glm::angleAxis(radians(-90), Vec3(1, 0, 0)), Vec3(half));
        scene_.place(square_, white_, flat);
    }
    /// The caustic map as an image whose first row has the smallest z.
    [[nodiscard]] gpu::FloatImage map() {
        (void)scene_.radiance(headless_, from_below({0, -0.1f, 0}));
        FrameGraph& graph = frame_graph(*headless_.renderer);
        gpu::FloatImage image = gpu::read_floats(*graph.texture(graph.find("caustics")));
        const std::vector<float> rows = image.pixels;
        const auto width = static_cast<std::size_t>(image.width);
        for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
            std::copy_n(
                rows.end() - static_cast<std::ptrdiff_t>((y + 1) * width), width,
                image.pixels.begin() + static_cast<std::ptrdiff_t>(y * width));
        }
        return image;
    }
    /// Light on the floor straight below `eye`.
    [[nodiscard]] double floor_below(const Vec3& eye) {
        const gpu::FloatImage below = scene_.radiance(headless_, from_below(eye));
        return static_cast<double>(below.at(below.width / 2, below.height / 2, 0));
    }
    [[nodiscard]] Vec2 slant() const {
        const Vec3 ray = refract_ray({0, 1, 0}, to_sun_, 1 / water().refractive_index);
        return Vec2(ray.x, ray.z) / -ray.y;
    }
    [[nodiscard]] const Water& water() const { return scene_.world.get<Water>(water_); }
    [[nodiscard]] World& world() { return scene_.world; }
    [[nodiscard]] Entity entity() const { return water_; }
    [[nodiscard]] glm::dvec3 to_sun() const { return glm::dvec3(to_sun_); }

  private:
    static RenderView from_below(const Vec3& eye) {
        const Affine pose =
            affine_from(eye, glm::angleAxis(radians(-90), Vec3(1, 0, 0)), {1, 1, 1});
        return make_render_view(
            {.fov_y = radians(60.0f), .near = 0.01f}, pose, pose, {.width = 64, .height = 64});
    }

    HeadlessRenderer& headless_;
    QualityScene scene_;
    Vec3 to_sun_;
    MaterialId white_;
    MeshId square_;
    Entity water_;
};

Vec3 sun_at(float degrees) {
    const float angle = radians(degrees);
    return {std::cos(angle) * 0.9211f, std::sin(angle), std::cos(angle) * 0.3894f};
}

WaterWaves some_waves() {
    return {
        .waves = {
            {.amplitude = 0.02f, .length = 1.1f, .direction = 0.3f},
            {.amplitude = 0.015f, .length = 0.8f, .direction = 1.9f, .phase = 1},
            {.amplitude = 0.01f, .length = 0.6f, .direction = -1.2f, .phase = 2},
            {.amplitude = 0.004f, .length = 0.3f, .direction = 2.6f, .phase = 3}}};
}

WaveTable& make_waves(Pool& pool) {
    WaveTable table;
    fill_wave_table(pool.water(), some_waves(), 1.0, table);
    pool.world().add(pool.entity(), table);
    return pool.world().get<WaveTable>(pool.entity());
}

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

/// Bilinear.
double sample(const gpu::FloatImage& map, const glm::dvec2& position) {
    const double size = 2 * static_cast<double>(kHalf) * kRim;
    const double x =
        std::clamp((position.x / size + 0.5) * map.width - 0.5, 0.0, map.width - 1.001);
    const double z =
        std::clamp((position.y / size + 0.5) * map.height - 0.5, 0.0, map.height - 1.001);
    const int i = static_cast<int>(x);
    const int j = static_cast<int>(z);
    const auto at = [&](int u, int v) { return static_cast<double>(map.at(u, v, 0)); };
    return (1 - (z - j)) * ((1 - (x - i)) * at(i, j) + (x - i) * at(i + 1, j))
           + (z - j) * ((1 - (x - i)) * at(i, j + 1) + (x - i) * at(i + 1, j + 1));
}

/// The light on the floor cells according to the map.
std::vector<double> floor_light(const gpu::FloatImage& map, const Vec2& slant) {
    constexpr int kPoints = 8;
    std::vector<double> cells;
    const double cell = 2 * static_cast<double>(kHalf) / kCells;
    const glm::dvec2 aside = glm::dvec2(slant) * static_cast<double>(kDepth);
    for (int k = 0; k < kCells * kCells; ++k) {
        double sum = 0;
        for (int p = 0; p < kPoints * kPoints; ++p) {
            const glm::dvec2 part(
                (p % kPoints + 0.5) / kPoints, (p / kPoints + 0.5) / kPoints);  // NOLINT
            const glm::dvec2 at =
                (glm::dvec2(k % kCells, k / kCells) + part) * cell - glm::dvec2(kHalf);  // NOLINT
            sum += sample(map, at - aside);
        }
        cells.push_back(sum / (kPoints * kPoints));
    }
    return cells;
}

/// Mean absolute difference over the mean, away from the walls [%].
double relative_error(const std::vector<double>& found, const oracle::CausticLight& exact) {
    double error = 0;
    double all = 0;
    for (int z = kNearWalls; z < kCells - kNearWalls; ++z) {
        for (int x = kNearWalls; x < kCells - kNearWalls; ++x) {
            error += std::abs(found[static_cast<std::size_t>(z * kCells + x)] - exact.at(x, z));
            all += exact.at(x, z);
        }
    }
    return 100 * error / all;
}

/// The cells that are compared, without those near the walls, which would also receive light from
/// beyond the pool.
ColorImage image_of(const std::vector<double>& cells) {
    constexpr int kScale = 8;
    constexpr int kSide = kScale * (kCells - 2 * kNearWalls);
    gpu::FloatImage image = {kSide, kSide, 3, {}};
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const int cell = (y / kScale + kNearWalls) * kCells + x / kScale + kNearWalls;
            const auto light = static_cast<float>(0.3 * cells[static_cast<std::size_t>(cell)]);
            image.pixels.insert(image.pixels.end(), {0.7f * light, light, light});
        }
    }
    return displayed(image);
}

void measure_flat(HeadlessRenderer& headless, QualityReport& report) {
    double worst = 0;
    for (const float height : {85.0f, 50.0f, 15.0f}) {
        Pool pool(headless, sun_at(height));
        const gpu::FloatImage map = pool.map();
        for (int z = 1; z < map.height - 1; ++z) {
            for (int x = 1; x < map.width - 1; ++x) {
                worst = std::max(worst, std::abs(static_cast<double>(map.at(x, z, 0)) - 1));
            }
        }
    }
    report.at_most("flat water: deviation from uniform light", 100 * worst, 0.5, "%");
}

void measure_photons(HeadlessRenderer& headless, QualityReport& report) {
    Pool pool(headless, sun_at(60));
    const WaveTable& table = make_waves(pool);
    const oracle::CausticLight all = oracle::trace_photons(
        {.half = glm::dvec2(kRim * static_cast<double>(kHalf)),
         .depth = kDepth,
         .index = static_cast<double>(pool.water().refractive_index),
         .boxes = {}},
        surface_of(table), pool.to_sun(), 1, 1'000'000);
    double received = 0;
    const gpu::FloatImage whole = pool.map();
    for (const float texel : whole.pixels) {
        received += static_cast<double>(texel);
    }
    received *= square(2 * kRim * static_cast<double>(kHalf) / whole.width);
    report.at_most(
        "energy: difference from the transmitted light", 100 * std::abs(received / all.entered - 1),
        1, "%");

    const oracle::CausticLight exact = oracle::trace_photons(
        {.half = glm::dvec2(kHalf),
         .depth = kDepth,
         .index = static_cast<double>(pool.water().refractive_index),
         .boxes = {}},
        surface_of(table), pool.to_sun(), kCells, kPhotons);
    double previous_error = 0;
    for (const int spacing : {8, 4, 2}) {
        pool.world().get<Caustics>(pool.entity()).spacing = spacing;
        const std::vector<double> found = floor_light(pool.map(), pool.slant());
        const double error = relative_error(found, exact);
        std::string name = fmt::format(
            "rays every {} of 512 texels: mean error of the light on the floor", spacing);
        if (spacing == 8) {
            report.inform(std::move(name), error, "%");
        } else {
            report.at_most(
                std::move(name), error,
                spacing == 2 ? std::min(previous_error, 3.0) : previous_error, "%");
        }
        previous_error = error;
        if (spacing == 2) {
            report.images.push_back(
                {"two meters of floor in the center of a pool with waves", image_of(found),
                 image_of(exact.floor)});
        }
    }
}

void measure_ripple_caustic(HeadlessRenderer& headless, QualityReport& report) {
    Pool pool(headless, {0.0f, 1.0f, 0.0f});
    double worst = 0;
    for (const float offset : {-1.0f, -0.2f, 0.9f}) {
        RippleState state = make_ripples(pool.water(), {.cell = 0.02f}, 1.0f / 60);
        const Vec2 center = 0.5f * (Vec2(state.cells) - 1.0f);
        for (int z = 0; z < state.cells.y; ++z) {
            for (int x = 0; x < state.cells.x; ++x) {
                const Vec2 from = (Vec2(x, z) - center) * state.cell - Vec2(offset, -0.5f * offset);
                state.height[state.at(x, z)] = 0.03f * std::exp(-glm::dot(from, from) / 0.08f);
            }
        }
        state.previous = state.height;
        if (pool.world().has<RippleState>(pool.entity())) {
            pool.world().get<RippleState>(pool.entity()) = state;
        } else {
            pool.world().add(pool.entity(), state);
        }
        const gpu::FloatImage map = pool.map();
        const auto brightest = std::max_element(map.pixels.begin(), map.pixels.end());
        const auto at = static_cast<int>(brightest - map.pixels.begin());
        const double texel = 2 * kRim * static_cast<double>(kHalf) / map.width;
        const double x = (at % map.width + 0.5 - 0.5 * map.width) * texel;
        const double z = (at / map.width + 0.5 - 0.5 * map.height) * texel;  // NOLINT
        worst = std::max(
            worst,
            std::hypot(x - static_cast<double>(offset), z + 0.5 * static_cast<double>(offset)));
    }
    report.at_most("a ripple at three positions: offset of its caustic", worst, 0.02, "m");
}

/// Light reflected upward by waves: the first square of the atlas.
void measure_mirrored(HeadlessRenderer& headless, QualityReport& report) {
    constexpr int kSide = 512;
    Pool pool(headless, sun_at(55));
    const WaveTable& table = make_waves(pool);
    pool.world().get<Caustics>(pool.entity()) = {
        .resolution = 64, .spacing = 1, .mirror_reach = 1.5f, .mirror_resolution = kSide};
    const oracle::CausticLight exact = oracle::trace_mirrored_photons(
        {.half = glm::dvec2(kHalf),
         .index = static_cast<double>(pool.water().refractive_index),
         .boxes = {}},
        surface_of(table), pool.to_sun(), 1.5, glm::dvec2(0), 1, 1'000'000);
    const gpu::FloatImage atlas = pool.map();
    double received = 0;
    for (int z = 0; z < kSide; ++z) {
        for (int x = 0; x < kSide; ++x) {
            received += static_cast<double>(atlas.at(x, z, 0));
        }
    }
    const double inner = kSide - 2 * (std::floor(0.2 * kSide) + 0.5);
    received *= square(2 * static_cast<double>(kHalf) / inner);
    report.at_most(
        "energy reflected upward: difference from the oracle",
        100 * std::abs(received / exact.entered - 1), 1, "%");
}

void measure_hole(HeadlessRenderer& headless, QualityReport& report) {
    Pool pool(headless, sun_at(45));
    constexpr float kPlateHeight = -0.75f;
    const Vec2 aside = pool.slant() * (kDepth + kPlateHeight);
    const Vec3 in_hole(aside.x, -1.2f, aside.y);
    const double open = pool.floor_below(in_hole);
    pool.add_plate({0, kPlateHeight, 0}, 0.2f);
    report.at_most(
        "behind an obstacle in the water: light left", 100 * pool.floor_below(in_hole) / open, 0.1,
        "%");
    report.at_least(
        "beside that shadow: light left",
        100 * pool.floor_below(in_hole + Vec3(0.35f, 0, 0)) / open, 98, "%");
}

Status measure_caustics(HeadlessRenderer& headless, QualityReport& report) {
    measure_flat(headless, report);
    measure_photons(headless, report);
    measure_ripple_caustic(headless, report);
    measure_hole(headless, report);
    measure_mirrored(headless, report);
    return Done{};
}

const RegisterQuality kRegistered(
    "caustics",
    "ten million photons through the same waves in double precision, and energy conservation",
    measure_caustics);

}  // namespace
}  // namespace limn::caustics_quality
