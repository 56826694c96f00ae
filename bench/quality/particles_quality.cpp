#include "bench/oracles/particle_shadow_oracle.h"
#include "bench/quality/quality_scene.h"
#include "ecs/base/depth_sort.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/light.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "ecs/components/weather.h"
#include "render/particles/gpu_particle_pools.h"
#include "systems/particles/gpu_particle_system.h"
#include "systems/particles/particle_obstacles.h"
#include "systems/particles/particle_system.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace limn::particles_quality {
namespace {

using glm::dvec3;

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr float kStep = 1.0f / 60;

/// One emitter in its own world, advanced step by step.
struct Fountain : QualityScene {
    Entity emitter;

    Fountain(const ParticleEmitter& settings, const ParticleMotion& motion) {
        world.insert_resource(FrameTime{.step = kStep});
        world.insert_resource(RandomSeed{});
        world.insert_resource(WeatherState{});
        world.insert_resource(ParticleObstacles{});
        world.insert_resource(GpuShapes{});
        emitter = world.create(
            settings, motion, WorldTransform{placed_at({0, 0, 0})},
            PreviousWorldTransform{placed_at({0, 0, 0})});
        world.run(add_particle_pools);
        world.run(add_gpu_particles);
    }
    void step(int steps) {
        for (int i = 0; i < steps; ++i) {
            auto& time = world.resource<FrameTime>();
            time.time += static_cast<double>(kStep);
            ++time.frame;
            world.run(find_particle_obstacles);
            world.run(update_particles);
            world.run(record_gpu_particles);
        }
    }
    [[nodiscard]] const ParticlePool& pool() const {
        return world.get<const ParticlePool>(emitter);
    }
};

dvec3 particle_position(const ParticlePool& pool, std::size_t i) {
    return {pool.x[i], pool.y[i], pool.z[i]};
}
dvec3 velocity_of(const ParticlePool& pool, std::size_t i) {
    return {pool.vx[i], pool.vy[i], pool.vz[i]};
}

ParticleEmitter burst_of(float count) {
    ParticleEmitter emitter;
    emitter.executor = ParticleExecutor::Cpu;
    emitter.rate = 0;
    emitter.bursts = {{.time = 0, .count = count}};
    emitter.capacity = static_cast<std::uint32_t>(count);
    emitter.cone = 1;
    emitter.speed = 6;
    emitter.speed_spread = 3;
    emitter.life = 100;
    emitter.life_spread = 0;
    emitter.seed = 7;
    return emitter;
}

// ---- motion

/// Positions of the particles on the GPU.
Result<std::vector<Vec3>> positions_on_gpu(HeadlessRenderer& headless, const Fountain& fountain) {
    gpu::Device& device = *headless.device;
    GpuParticlePools pools = LIMN_TRY(GpuParticlePools::create(device));
    gpu::RingBuffer ring(device.caps(), "steps", 1 << 20);
    FrameGraph graph(device);
    FrameData frame;
    frame.ring = &ring;
    ring.begin_frame();
    pools.begin_frame(fountain.world);
    pools.add(
        frame, fountain.emitter, fountain.world.get<const ParticleEmitter>(fountain.emitter),
        fountain.world.get<const GpuParticles>(fountain.emitter), 0);
    graph.begin_frame();
    pools.update(graph, {});
    graph.execute();
    ring.end_frame();
    const GpuParticlePool& pool = *pools.pools().begin()->second;
    std::vector<Vec4> slots(std::size_t{2} * pool.capacity);
    pool.state.read(0, std::as_writable_bytes(std::span(slots)));
    std::vector<Vec3> positions;
    for (std::uint32_t i = 0; i < pool.count; ++i) {
        positions.emplace_back(slots[2 * ((pool.first + i) % pool.capacity)]);
    }
    return positions;
}

/// Ten seconds of 5,000 particles under gravity, in moving air with drag.
Status measure_motion(HeadlessRenderer& headless, QualityReport& report) {
    constexpr int kSteps = 600;
    const ParticleMotion motion = {.gravity = 1, .drag = 0.4f, .wind = {2, 0, 1}};
    Fountain cpu(burst_of(5000), motion);
    ParticleEmitter on_gpu = burst_of(5000);
    on_gpu.executor = ParticleExecutor::Gpu;
    Fountain gpu(on_gpu, motion);
    cpu.step(1);
    std::vector<dvec3> x;
    std::vector<dvec3> v;
    for (std::size_t i = 0; i < cpu.pool().size(); ++i) {
        x.push_back(particle_position(cpu.pool(), i));
        v.push_back(velocity_of(cpu.pool(), i));
    }
    const std::vector<dvec3> x0 = x;
    const std::vector<dvec3> v0 = v;
    std::vector<double> length(x.size());

    // The plain loop: midpoint rule with steps of half a millisecond.
    constexpr int kParts = 32;
    const double dt = static_cast<double>(kStep);
    const double h = dt / kParts;
    const double k = static_cast<double>(motion.drag);
    const dvec3 air = {2, 0, 1};
    const dvec3 g = {0, -9.81, 0};
    for (std::size_t i = 0; i < x.size(); ++i) {
        for (int part = 0; part < (kSteps - 1) * kParts; ++part) {
            const dvec3 midpoint = v[i] + 0.5 * h * (g - k * (v[i] - air));
            v[i] += h * (g - k * (midpoint - air));
            x[i] += h * midpoint;
            length[i] += h * glm::length(midpoint);
        }
    }
    cpu.step(kSteps - 1);
    gpu.step(kSteps);
    const std::vector<Vec3> gpu_positions = LIMN_TRY(positions_on_gpu(headless, gpu));

    const double t = (kSteps - 1) * dt;
    double cpu_error = 0;
    double gpu_error = 0;
    double exact_error = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const dvec3 found = particle_position(cpu.pool(), i);
        cpu_error = std::max(cpu_error, glm::distance(found, x[i]) / length[i]);
        gpu_error = std::max(gpu_error, glm::distance(dvec3(gpu_positions[i]), x[i]) / length[i]);
        const dvec3 last = air + g / k;  // terminal velocity
        const dvec3 exact = x0[i] + last * t + (v0[i] - last) * ((1 - std::exp(-k * t)) / k);
        exact_error = std::max(exact_error, glm::distance(found, exact) / length[i]);
    }
    report.at_most("CPU: distance to the plain loop, relative to the path length", cpu_error, 1e-4);
    report.at_most("GPU: distance to the plain loop, relative to the path length", gpu_error, 1e-4);
    report.at_most(
        "CPU: distance to the exact motion, relative to the path length", exact_error, 1e-4);
    return Done{};
}

// ---- population

/// An emitter whose pool is too small, for ten seconds.
void measure_population(QualityReport& report) {
    ParticleEmitter emitter = burst_of(500);
    emitter.bursts.clear();
    emitter.rate = 700;
    emitter.life = 1;
    emitter.life_spread = 0.5f;
    Fountain fountain(emitter, {});
    double lost = 0;
    std::size_t largest = 0;
    for (int i = 0; i < 600; ++i) {
        const ParticlePool& before = fountain.pool();
        double expected =
            static_cast<double>(before.size()) - static_cast<double>(before.clock.born);
        for (std::size_t k = 0; k < before.size(); ++k) {
            expected -= before.age[k] + kStep >= before.life[k] ? 1 : 0;
        }
        fountain.step(1);
        const ParticlePool& after = fountain.pool();
        expected += static_cast<double>(after.clock.born);
        lost += std::abs(static_cast<double>(after.size()) - expected);
        largest = std::max(largest, after.size());
    }
    const EmitterClock& clock = fountain.pool().clock;
    const double counted = static_cast<double>(clock.born + clock.dropped);
    report.at_most("a full pool, 10 s: births that are neither alive nor dead of age", lost, 0);
    report.at_most(
        "a full pool, 10 s: of 7,000 spawns, neither done nor counted as dropped",
        std::abs(7000 - counted), 1);
    report.at_most("a full pool, 10 s: alive, capacity 500", static_cast<double>(largest), 500);
}

// ---- order

template <typename Key>
double misplaced(const std::vector<Key>& keys) {
    std::vector<std::uint32_t> found(keys.size());
    std::iota(found.begin(), found.end(), 0u);
    std::vector<std::uint32_t> expected = found;
    std::stable_sort(expected.begin(), expected.end(), [&](std::uint32_t a, std::uint32_t b) {
        return keys[a] < keys[b];
    });
    SortScratch scratch;
    sort_by_depth(std::span<const Key>(keys), found, scratch, SortThreads::All);
    double count = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        count += found[i] != expected[i] ? 1 : 0;
    }
    return count;
}

/// A million depths, some 200 of them equal to each.
void measure_order(QualityReport& report) {
    std::vector<std::uint32_t> keys;
    std::vector<std::uint16_t> short_keys;
    for (std::uint32_t i = 0; i < 1000000; ++i) {
        const float depth = static_cast<float>((i * 2654435761u) % 5003) / 100;
        keys.push_back(depth_key(depth));
        short_keys.push_back(depth_key16(depth, 0, 51));
    }
    report.at_most(
        "sort of 1M by 32 bits: positions that differ from std::stable_sort", misplaced(keys), 0);
    report.at_most(
        "sort of 1M by 16 bits: positions that differ from std::stable_sort", misplaced(short_keys),
        0);
}

// ---- collisions

/// 20,000 particles at 60 m/s against a sheet of triangles, at 60 steps a second.
void measure_tunnelling(QualityReport& report) {
    ParticleEmitter emitter = burst_of(20000);
    emitter.speed = 60;
    emitter.speed_spread = 0;
    Fountain fountain(emitter, {.gravity = 0});
    fountain.world.add(fountain.emitter, ParticleCollision{.bounce = 0.5f});
    const MeshId sheet = fountain.add(quality_square());
    fountain.world.create(
        ParticleCollider{.shape = ColliderShape::Mesh}, MeshInstance{sheet, {}},
        WorldTransform{
            affine_from({0, 3, 0}, glm::angleAxis(0.5f * kPi, Vec3(1, 0, 0)), Vec3(300))});
    fountain.step(60);
    double through = 0;
    for (const float y : fountain.pool().y) {
        through += y > 3 ? 1 : 0;
    }
    report.at_most("60 m/s against a sheet without thickness: got through", through, 0);
}

// ---- transparency

constexpr ColorKey kColors[] = {
    {0, {1, 0.3f, 0.1f}, 0.9f}, {0.5f, {0.9f, 0.8f, 0.2f}, 0.7f}, {1, {0.1f, 0.3f, 0.9f}, 0.8f}};

/// Color and opacity at a relative age, linear between keys.
glm::dvec4 color_at(double age) {
    const int i = age < 0.5 ? 0 : 1;
    const auto key = [](const ColorKey& color_key) {
        return glm::dvec4(color_key.color, static_cast<double>(color_key.opacity));
    };
    return glm::mix(key(kColors[i]), key(kColors[i + 1]), 2 * age - i);
}

/// Blends all discs of a pixel in the order in which its ray hits them.
dvec3 blend_exactly(const ParticlePool& pool, double radius, const dvec3& eye, const dvec3& ray) {
    struct Hit {
        double distance;
        glm::dvec4 color;
    };
    std::vector<Hit> hits;
    for (std::size_t i = 0; i < pool.size(); ++i) {
        const dvec3 center = particle_position(pool, i);
        const dvec3 normal = glm::normalize(eye - center);
        const double distance = glm::dot(center - eye, normal) / glm::dot(ray, normal);
        const dvec3 off = (eye + distance * ray - center) / radius;
        const double inside = 1 - glm::dot(off, off);
        if (distance > 0 && inside > 0) {
            glm::dvec4 color =
                color_at(static_cast<double>(pool.age[i]) / static_cast<double>(pool.life[i]));
            color.w *= inside * inside;
            hits.push_back({distance, color});
        }
    }
    std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
        return a.distance > b.distance;
    });
    dvec3 sum(0);
    for (const Hit& hit : hits) {
        sum = glm::mix(sum, dvec3(hit.color), hit.color.w);
    }
    return sum;
}

ColorImage draw_exactly(const ParticlePool& pool, const RenderView& view) {
    gpu::FloatImage image{.width = kWidth, .height = kHeight, .channels = 3, .pixels = {}};
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const dvec3 color = blend_exactly(pool, 0.225, eye_of(view), pixel_ray(view, x, y));
            for (int c = 0; c < 3; ++c) {
                image.pixels.push_back(static_cast<float>(color[c]));
            }
        }
    }
    return displayed(image);
}

/// Colored puffs that intersect each other.
void measure_transparency(HeadlessRenderer& headless, QualityReport& report) {
    ParticleEmitter emitter;
    emitter.rate = 150;
    emitter.shape = EmitterShape::Ball;
    emitter.size = {1.3f, 0.7f, 1.3f};
    emitter.speed = emitter.speed_spread = 0;
    emitter.life = 3;
    emitter.life_spread = 0;
    emitter.seed = 3;
    ParticleLook look;
    look.size = 0.45f;
    look.emission = 1;
    look.lit = 0;
    look.softness = 0;
    look.colors.assign(std::begin(kColors), std::end(kColors));
    const RenderView view =
        quality_view({0.4f, 0.8f, 3}, {0, 0, 0}, kWidth, kHeight, radians(45.0f));
    ColorImage truth;
    for (const auto& [name, executor] :
         {std::pair("CPU", ParticleExecutor::Cpu), std::pair("GPU", ParticleExecutor::Gpu)}) {
        emitter.executor = executor;
        Fountain fountain(emitter, {.gravity = 0});
        fountain.step(180);
        fountain.world.add(fountain.emitter, ParticleLook(look));
        const gpu::FloatImage found = fountain.render(headless, view);
        const ColorImage effect = displayed(found);
        if (executor == ParticleExecutor::Cpu) {
            truth = draw_exactly(fountain.pool(), view);
        }
        report.at_least(
            std::string(name) + ": 400 puffs against sorting in each pixel", psnr(effect, truth),
            30, "dB");
        const auto drawn_by = [&](ParticleSort sort) {
            look.sort = sort;
            fountain.world.add(fountain.emitter, ParticleLook(look));
            return psnr(displayed(fountain.render(headless, view)), truth);
        };
        report.at_least(
            std::string(name) + ": the same weighted instead of sorted",
            drawn_by(ParticleSort::Weighted), 30, "dB");
        report.inform(
            std::string(name) + ": the same in the order of births", drawn_by(ParticleSort::Births),
            "dB");
        look.sort = ParticleSort::Distance;
        report.images.push_back({std::string("puffs, ") + name, effect, truth});
    }
}

// ---- shadows

/// A wall among the puffs, then behind them: each pixel compared with the sum of all optical
/// depths.
void measure_shadows(HeadlessRenderer& headless, QualityReport& report) {
    ParticleEmitter emitter;
    emitter.executor = ParticleExecutor::Cpu;
    emitter.rate = 60;
    emitter.shape = EmitterShape::Ball;
    emitter.size = {1.1f, 1.1f, 1.4f};
    emitter.speed = emitter.speed_spread = 0;
    emitter.life = 3;
    emitter.life_spread = 0;
    emitter.seed = 5;
    ParticleLook look;
    look.size = 0.7f;
    look.colors = {{.at = 0, .opacity = 0.35f}};
    look.near_fade = 1000;  // invisible to the camera
    Fountain fountain(emitter, {.gravity = 0});
    fountain.step(180);
    fountain.add_light(DirectionalLight{.illuminance = 3}, placed_at({0, 0, 5}));
    std::vector<oracle::ShadowDisc> discs;
    for (std::size_t i = 0; i < fountain.pool().size(); ++i) {
        discs.push_back(
            {.center = particle_position(fountain.pool(), i), .diameter = 0.7, .opacity = 0.35});
    }
    const MeshId square = fountain.add(quality_square());
    const MaterialId white = fountain.add(Material{.base_color = {1, 1, 1, 1}, .roughness = 1});
    for (const float z : {-2.0f, 0.0f}) {
        const Entity wall = fountain.place(square, white, placed_at({0, 0, z}, 2));
        const RenderView view =
            quality_view({0, 0, z + 2}, {0, 0, z}, kHeight, kHeight, radians(90.0f));
        look.shadow = 0;
        fountain.world.add(fountain.emitter, ParticleLook(look));
        const gpu::FloatImage open = fountain.render(headless, view);
        look.shadow = 1;
        fountain.world.add(fountain.emitter, ParticleLook(look));
        const gpu::FloatImage found = fountain.render(headless, view);
        double sum = 0;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kHeight; ++x) {
                const dvec3 point = eye_of(view) + 2.0 * pixel_ray(view, x, y);
                const double exact = oracle::disc_transmittance(discs, point, {0, 0, -1});
                const auto transmitted = static_cast<double>(found.at(x, y, 0) / open.at(x, y, 0));
                sum += (transmitted - exact) * (transmitted - exact);
            }
        }
        report.at_most(
            std::string("shadow of 180 puffs, ") + (z < 0 ? "behind" : "among")
                + " them: RMS error of the transmittance",
            std::sqrt(sum / (kHeight * kHeight)), z < 0 ? 0.002 : 0.01);
        fountain.world.destroy(wall);
    }
}

Status measure_particles(HeadlessRenderer& headless, QualityReport& report) {
    LIMN_TRY(measure_motion(headless, report));
    measure_population(report);
    measure_order(report);
    measure_tunnelling(report);
    measure_transparency(headless, report);
    measure_shadows(headless, report);
    return Done{};
}

const RegisterQuality kRegistered(
    "particles",
    "a plain loop in double precision; sorting in each pixel; the sum of optical depths",
    measure_particles);

}  // namespace
}  // namespace limn::particles_quality
