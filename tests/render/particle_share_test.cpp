// Rendering::particle_share: of the particles that the GPU moves, every nth is moved and drawn.

#include "ecs/components/gpu_particles.h"
#include "ecs/components/particles.h"
#include "ecs/components/rendering.h"
#include "ecs/components/time.h"
#include "ecs/components/weather.h"
#include "render/particles/gpu_particle_pools.h"
#include "render/particles/particle_list.h"
#include "systems/particles/gpu_particle_system.h"
#include "systems/particles/particle_obstacles.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace limn::test::particle_share_test {
namespace {

/// A fountain of glowing discs, born and dead all the time, that the GPU moves.
struct Fountain : Scene {
    Entity emitter;
    GpuParticlePools pools = *GpuParticlePools::create(device());
    FrameGraph graph{device()};
    gpu::RingBuffer ring{device().caps(), "steps", 1 << 20};

    Fountain() {
        world.insert_resource(FrameTime{});
        world.insert_resource(RandomSeed{});
        world.insert_resource(WeatherState{});
        world.insert_resource(ParticleObstacles{});
        world.insert_resource(GpuShapes{});
        ParticleEmitter settings;
        settings.executor = ParticleExecutor::Gpu;
        settings.rate = 80000;
        settings.capacity = 100000;
        settings.life = 0.75f;
        settings.life_spread = 0.2f;
        settings.speed = 2;
        settings.cone = 1;
        settings.seed = 5;
        ParticleMotion motion;
        motion.gravity = 0.3f;
        ParticleLook look;
        look.size = 0.03f;
        look.size_spread = 0.01f;
        look.softness = 0;
        look.emission = 1;
        look.lit = 0;
        look.cover = 0;
        emitter = world.create(
            settings, motion, look, WorldTransform{at({0, 0, 0})},
            PreviousWorldTransform{at({0, 0, 0})});
        world.run(add_gpu_particles);
    }
    void step(int steps) {
        for (int i = 0; i < steps; ++i) {
            FrameTime& time = world.resource<FrameTime>();
            time.time += static_cast<double>(time.step);
            ++time.frame;
            world.run(find_particle_obstacles);
            world.run(record_gpu_particles);
        }
    }
    /// Lets the GPU move every `stride`th, and reads what is to be drawn.
    std::vector<ParticleInstance> moved(std::uint32_t stride) {
        FrameData frame;
        frame.ring = &ring;
        ring.begin_frame();
        pools.begin_frame(world);
        pools.add(
            frame, emitter, world.get<const ParticleEmitter>(emitter),
            world.get<GpuParticles>(emitter), 0, std::nullopt, nullptr, stride);
        graph.begin_frame();
        pools.update(graph, {});
        graph.execute();
        ring.end_frame();
        std::vector<ParticleInstance> instances(pool().count);
        pool().instances.read(0, std::as_writable_bytes(std::span(instances)));
        return instances;
    }
    [[nodiscard]] const GpuParticlePool& pool() const { return *pools.pools().begin()->second; }
    [[nodiscard]] RenderView view() const { return look({0, 0.4f, 3}, {0, 0.4f, 0}, 160, 120); }
    /// The sum of red over the image.
    double light(float share) {
        world.insert_resource(Rendering{.particle_share = share});
        const gpu::FloatImage image = radiance(view());
        double sum = 0;
        for (std::size_t i = 0; i < image.pixels.size();
             i += static_cast<std::size_t>(image.channels)) {
            sum += static_cast<double>(image.pixels[i]);
        }
        return sum;
    }
};

bool equal(const ParticleInstance& a, const ParticleInstance& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace

TEST_CASE("particle share: the stride is the least power of two that leaves the fraction or less") {
    CHECK(particle_stride(1) == 1);
    CHECK(particle_stride(0.99f) == 2);
    CHECK(particle_stride(0.5f) == 2);
    CHECK(particle_stride(0.3f) == 4);
    CHECK(particle_stride(1.0f / 1024) == 1024);
    CHECK(particle_stride(0) == 1024);
    CHECK(particle_stride(-1) == 1024);
    CHECK(particle_stride(std::nanf("")) == 1);
}

TEST_CASE(
    "particle share: those that are left have the states that they have among all, to the bit") {
    for (const std::uint32_t stride : {2u, 8u, 64u}) {
        Fountain all;
        Fountain some;
        CAPTURE(stride);
        for (int frame = 0; frame < 6; ++frame) {
            all.step(17);
            some.step(17);
            const std::vector<ParticleInstance> every = all.moved(1);
            const std::vector<ParticleInstance> left = some.moved(stride);
            const std::size_t first = (0u - all.pool().first) % stride;
            REQUIRE(left.size() == (every.size() - first + stride - 1) / stride);
            bool same = true;
            for (std::size_t i = 0; i < left.size(); ++i) {
                same = same && equal(left[i], every[first + stride * i]);
            }
            CHECK(same);
        }
        CHECK(all.pool().first > 0);  // some have died
    }
}

TEST_CASE("particle share: it may rise and fall at any time") {
    Fountain all;
    Fountain some;
    for (const std::uint32_t stride : {4u, 16u, 1u, 2u, 1u}) {
        all.step(20);
        some.step(20);
        const std::vector<ParticleInstance> every = all.moved(1);
        const std::vector<ParticleInstance> left = some.moved(stride);
        const std::size_t first = (0u - all.pool().first) % stride;
        bool same = !left.empty();
        for (std::size_t i = 0; i < left.size(); ++i) {
            same = same && equal(left[i], every[first + stride * i]);
        }
        CAPTURE(stride);
        CHECK(same);
    }
}

TEST_CASE("particle share: 1/4 and 1/16 keep the light of the image within 5 and 10 %") {
    Fountain all;
    all.step(90);
    const double full = all.light(1);
    CHECK(full > 100);
    CHECK(all.light(0.25f) == near(full).epsilon(0.05));
    CHECK(all.light(0.0625f) == near(full).epsilon(0.10));
    CHECK(all.light(1) == full);
}

}  // namespace limn::test::particle_share_test
