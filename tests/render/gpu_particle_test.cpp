// The two executors of particles: the same happens on the GPU as on the CPU.

#include "ecs/components/force_field.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/particle_balls.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particle_surface.h"
#include "ecs/components/particles.h"
#include "ecs/components/shadow.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/trail.h"
#include "ecs/components/water.h"
#include "ecs/components/water_spray.h"
#include "ecs/components/weather.h"
#include "render/particles/gpu_particle_pools.h"
#include "render/particles/particle_list.h"
#include "render/shaders/particle_gpu.h"
#include "systems/particles/gpu_particle_system.h"
#include "systems/particles/particle_obstacles.h"
#include "systems/particles/particle_system.h"
#include "tests/near.h"
#include "tests/render/particle_executors.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace limn::test::gpu_particle_test {

TEST_CASE(
    "gpu particles: for ten seconds they are where the CPU has them"
    * technique("particle.gpu-init, particle.gpu-update, particle.million")) {
    for (const EmitterShape shape :
         {EmitterShape::Point, EmitterShape::Ball, EmitterShape::Sphere, EmitterShape::Disc,
          EmitterShape::Circle, EmitterShape::Box, EmitterShape::Torus}) {
        CAPTURE(static_cast<int>(shape));
        ParticleEmitter emitter = fountain();
        emitter.shape = shape;
        emitter.direction =
            shape == EmitterShape::Ball ? EmitterDirection::Radial : EmitterDirection::Cone;
        ParticleMotion motion;
        motion.drag = 0.4f;
        motion.wind = {1, 0, 0.5f};
        Executors both(emitter, motion);
        both.step(600);
        const std::vector<GpuParticle> gpu = both.read();
        REQUIRE(gpu.size() == 4000);
        REQUIRE(both.pool().size() == 4000);
        CHECK(largest_distance(gpu, both.pool(), 10 * 3.0f) < 1e-4f);
    }
}

TEST_CASE(
    "gpu particles: shells and velocities vary as on the CPU"
    * technique("engine.particle-params")) {
    ParticleEmitter emitter = fountain();
    emitter.shape = EmitterShape::Sphere;
    emitter.size = {2, 2, 0};
    emitter.size_spread = {0.2f, 0.3f, 0.4f};
    emitter.velocity_spread = {1, 0.5f, 2};
    Executors both(emitter, {});
    both.step(120);
    const std::vector<GpuParticle> gpu = both.read();
    REQUIRE(gpu.size() == both.pool().size());
    CHECK(gpu.size() > 500);
    CHECK(largest_distance(gpu, both.pool(), 10 * 3.0f) < 1e-4f);
}

TEST_CASE(
    "gpu particles: the window of a linear population moves down and ends"
    * technique("particle.linear-window")) {
    ParticleEmitter emitter = fountain();
    emitter.population = ParticlePopulation::Linear;
    emitter.capacity = 1000;
    emitter.rate = 6000;
    emitter.life = 0.5f;
    emitter.life_spread = 0.3f;
    Executors both(emitter, {});
    std::uint64_t tail = 0;
    std::size_t most = 0;
    for (int i = 0; i < 90; ++i) {
        both.step();
        const GpuParticles& window = both.recorded();
        REQUIRE(window.oldest() <= window.clock.born);
        REQUIRE(window.clock.born <= 1000);
        REQUIRE(window.oldest() >= tail);
        tail = window.oldest();
        if (i % 10 == 0) {
            // The dead within the window are skipped.
            const std::size_t alive = both.read().size();
            CHECK(alive <= window.clock.born - tail);
            CHECK(alive == both.pool().size());
            most = std::max(most, alive);
        }
    }
    CHECK(most > 500);
    CHECK(both.recorded().clock.born == 1000);
    CHECK(both.recorded().clock.dropped == 8000);
    CHECK(both.recorded().oldest() == 1000);
    CHECK(both.read().empty());
}

TEST_CASE(
    "gpu particles: forces, turns and integrators are those of the CPU"
    * technique("particle.gpu-update, particle.gpu-update-mrt")) {
    for (const ParticleIntegrator integrator :
         {ParticleIntegrator::Average, ParticleIntegrator::ExplicitEuler,
          ParticleIntegrator::SemiImplicit}) {
        CAPTURE(static_cast<int>(integrator));
        ParticleMotion motion;
        motion.gravity = -0.02f;
        motion.drag = 1.5f;
        motion.turbulence = 0.6f;
        motion.turbulence_size = 1.5f;
        motion.vortex = 0.7f;
        motion.attraction = 0.5f;
        motion.orbit = 0.02f;
        motion.brake = 0.1f;
        motion.integrator = integrator;
        ParticleEmitter emitter = fountain();
        emitter.life = 3;
        emitter.shape =
            EmitterShape::Sphere;  // not on the axis, where rounding would choose a side
        emitter.size = Vec3(0.5f);
        Executors both(emitter, motion);
        both.step(300);
        const std::vector<GpuParticle> gpu = both.read();
        REQUIRE(gpu.size() == both.pool().size());
        CHECK(gpu.size() >= 1200);
        CHECK(largest_distance(gpu, both.pool(), 10 * 3.0f) < 1e-4f);
    }
}

TEST_CASE(
    "gpu particles: drawn after each step, they keep to their circles as on the CPU"
    * technique("particle.gpu-update")) {
    ParticleEmitter emitter = fountain();
    emitter.rate = 0;
    emitter.bursts = {{.time = 0, .count = 200}};
    emitter.life = 1000;
    emitter.shape = EmitterShape::Sphere;  // not on the axis, as above
    emitter.size = Vec3(0.5f);
    for (const ParticleIntegrator integrator :
         {ParticleIntegrator::Average, ParticleIntegrator::ExplicitEuler}) {
        for (const float brake : {0.0f, 0.2f}) {
            CAPTURE(brake);
            ParticleMotion motion;
            motion.gravity = 0.1f;
            motion.orbit = 0.7f;
            motion.brake = brake;
            motion.integrator = integrator;
            Executors both(emitter, motion);
            for (int i = 0; i < 120; ++i) {
                both.step(1);
                (void)both.read();
            }
            const std::vector<GpuParticle> gpu = both.read();
            REQUIRE(gpu.size() == 200);
            CHECK(largest_distance(gpu, both.pool(), 6) < 1e-4f);
        }
    }
}

TEST_CASE(
    "gpu particles: force fields push them as they push the CPU's" * technique("particle.forces")) {
    ParticleEmitter emitter = fountain();
    emitter.life = 3;
    emitter.shape = EmitterShape::Ball;
    emitter.size = Vec3(1);
    Executors both(emitter, {.gravity = 0.1f, .fields = 0.8f});
    const Quat leaning = glm::normalize(Quat(0.8f, 0.1f, 0.3f, -0.2f));
    float x = 0;
    for (const ForceKind kind :
         {ForceKind::Push, ForceKind::Attract, ForceKind::Spring, ForceKind::Whirl,
          ForceKind::Wind}) {
        x += 0.5f;
        both.world.create(
            ForceField{.kind = kind, .strength = 1.3f, .speed = 2, .radius = 5, .frequency = x},
            WorldTransform{affine_from({x, 3, 2 * x}, leaning, Vec3(1))});
    }
    both.step(300);
    const std::vector<GpuParticle> gpu = both.read();
    REQUIRE(gpu.size() == both.pool().size());
    CHECK(gpu.size() >= 1200);
    CHECK(largest_distance(gpu, both.pool(), 10 * 3.0f) < 1e-4f);
}

TEST_CASE(
    "gpu particles: how often they are drawn changes nothing" * technique("particle.gpu-state")) {
    ParticleEmitter emitter = fountain();
    emitter.rate = 60;
    emitter.bursts = {{.time = 0.4f, .count = 500, .spread = 100, .interval = 1, .repeats = 9}};
    emitter.life = 2;
    emitter.life_spread = 1.5f;
    Executors seldom(emitter, {});
    Executors often(emitter, {});
    for (int i = 0; i < 50; ++i) {
        seldom.step(5);
        for (int k = 0; k < 5; ++k) {
            often.step();
            if (k != 2) {
                (void)often.read();
            }
        }
    }
    const std::vector<GpuParticle> a = seldom.read();
    const std::vector<GpuParticle> b = often.read();
    REQUIRE(a.size() == b.size());
    REQUIRE(a.size() > 500);
    CHECK(a.size() == seldom.pool().size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        CHECK(a[i].position_age == b[i].position_age);
        CHECK(a[i].velocity_life == b[i].velocity_life);
    }
}

TEST_CASE(
    "gpu particles: a ring keeps order, refuses births when full and counts them"
    * technique("particle.circular-list")) {
    ParticleEmitter emitter = fountain();
    emitter.capacity = 1000;
    emitter.rate = 6000;
    emitter.life = 0.5f;
    Executors both(emitter, {});
    std::uint64_t last = 0;
    for (int i = 0; i < 200; ++i) {
        both.step();
        const std::uint64_t window = both.recorded().clock.born - both.recorded().oldest();
        REQUIRE(window <= 1000);
        REQUIRE(both.recorded().oldest() >= last);
        last = both.recorded().oldest();
        if (i % 37 == 0) {
            const std::vector<GpuParticle> alive = both.read();
            CHECK(alive.size() <= window);
            CHECK(std::is_sorted(alive.begin(), alive.end(), [](const auto& a, const auto& b) {
                return a.position_age.w > b.position_age.w;  // oldest first
            }));
        }
    }
    const EmitterClock& clock = both.recorded().clock;
    CHECK(clock.dropped > 0);
    CHECK(clock.born + clock.dropped == 20000);
    CHECK(both.recorded().kept().size() <= 32);
    CHECK(both.recorded().cohorts.size() <= 32);
}

TEST_CASE(
    "gpu particles: across the end of the ring they go where the CPU's go"
    * technique("particle.gpu-update")) {
    ParticleEmitter emitter = fountain();
    emitter.capacity = 1000;  // 800 live, 2,000 are born
    emitter.life = 2;
    for (const float drag : {0.0f, 0.4f}) {
        Executors both(emitter, {.gravity = 0.3f, .drag = drag});
        for (int i = 0; i < 300; ++i) {
            both.step();
            const std::vector<GpuParticle> gpu = both.read();
            REQUIRE(gpu.size() == both.pool().size());
            CHECK(largest_distance(gpu, both.pool(), 6) <= 1e-4f);
        }
    }
}

TEST_CASE(
    "gpu particles: when the GPU starts over they are where they were"
    * technique("particle.gpu-state")) {
    ParticleEmitter emitter = fountain();
    emitter.prewarm = 1;
    emitter.life = 2.5f;
    Executors both(emitter, {});
    both.step(90);
    const std::vector<GpuParticle> before = both.read();
    both.pools = *GpuParticlePools::create(RenderTest::device());
    const std::vector<GpuParticle> after = both.read();
    REQUIRE(before.size() == 1000);
    REQUIRE(after.size() == before.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        CHECK(after[i].position_age == before[i].position_age);
    }
    // Of those that live longer, steps are kept for a minute.
    emitter.rate = 0;
    emitter.bursts = {{.time = 0, .count = 10}};
    emitter.prewarm = 0;
    emitter.life = 1e5f;
    Executors eternal(emitter, {});
    eternal.step(5000);
    CHECK(eternal.recorded().kept().size() <= 3601);
    CHECK(eternal.recorded().steps.size() <= 7205);
    CHECK(eternal.read().size() == 0);  // the steps of their births were dropped
    Executors drawn(emitter, {});
    drawn.step(10);
    CHECK(drawn.read().size() == 10);
    drawn.step(3000);
    (void)drawn.read();
    drawn.step(3000);
    CHECK(drawn.read().size() == 10);
}

TEST_CASE(
    "gpu particles: a closed form is its parabola, however long the steps are"
    * technique("particle.stateless-script")) {
    for (const float step : {1.0f / 24, 1.0f / 60, 1.0f / 144}) {
        ParticleEmitter emitter = fountain();
        emitter.life = 1.5f;
        emitter.cone = 1;
        Executors both(emitter, {.gravity = 2, .integrator = ParticleIntegrator::ClosedForm});
        both.world.resource<FrameTime>().step = step;
        both.step(static_cast<int>(std::round(1.2f / step)));
        // On the GPU the state stays that of birth.
        const std::vector<GpuParticle> born = both.read();
        const std::vector<ParticleInstance> drawn = both.drawn();
        const ParticlePool& cpu = both.pool();
        REQUIRE(born.size() > 400);
        REQUIRE(cpu.size() == born.size());
        const std::size_t dead = drawn.size() - born.size();
        for (std::size_t i = 0; i < born.size(); ++i) {
            const float age = born[i].position_age.w;
            CHECK(age == near(cpu.age[i]).scale(1).epsilon(1e-5));
            Vec3 position = Vec3(born[i].position_age) + Vec3(born[i].velocity_life) * age;
            position.y -= 9.81f * age * age;
            CHECK(glm::distance(drawn[dead + i].position, position) < 1e-5f);
            CHECK(glm::distance(Vec3(cpu.x[i], cpu.y[i], cpu.z[i]), position) < 2e-4f);
        }
    }
}

TEST_CASE(
    "gpu particles: on a surface and in a volume they are born where the CPU's are"
    * technique("particle.gpu-init, particle.mesh-volume")) {
    for (const BirthSurface on : {BirthSurface::Mesh, BirthSurface::Volume}) {
        CAPTURE(static_cast<int>(on));
        ParticleEmitter emitter = fountain();
        emitter.shape = EmitterShape::Disc;
        emitter.prewarm = 0.3f;
        emitter.life = 2;
        emitter.velocity_spread = {0.2f, 0.3f, 0.1f};
        Executors both(emitter, {.drag = 0.3f});
        const Entity ball = both.world.create(
            MeshInstance{.mesh = both.add(make_ball(16)), .material = {}}, WorldTransform{},
            PreviousWorldTransform{});
        for (const Entity entity : {both.cpu, both.gpu}) {
            both.world.add(
                entity, ParticleSurface{.on = on, .entity = ball, .offset = 0.1f, .inherit = 0.7f});
        }
        for (int i = 0; i < 100; ++i) {
            const Quat turn = glm::angleAxis(0.03f * static_cast<float>(i), Vec3(0.6f, 0, 0.8f));
            both.world.get<PreviousWorldTransform>(ball).world =
                both.world.get<const WorldTransform>(ball).world;
            both.world.get<WorldTransform>(ball).world =
                affine_from({0.02f * static_cast<float>(i), 1, 3}, turn, {1, 2, 1.5f});
            both.step();
        }
        const std::vector<GpuParticle> gpu = both.read();
        REQUIRE(gpu.size() == both.pool().size());
        CHECK(gpu.size() > 500);
        CHECK(largest_distance(gpu, both.pool(), 6) < 1e-4f);
    }
    // A volume that is not closed has no points: births are counted, and nothing is seen.
    Executors none(fountain(), {});
    const Entity open = none.world.create(
        MeshInstance{.mesh = none.add(make_square()), .material = {}}, WorldTransform{},
        PreviousWorldTransform{});
    for (const Entity entity : {none.cpu, none.gpu}) {
        none.world.add(entity, ParticleSurface{.on = BirthSurface::Volume, .entity = open});
    }
    none.step(30);
    CHECK(none.pool().size() == 0);
    CHECK(none.read().empty());
    CHECK(none.recorded().clock.dropped == none.pool().clock.dropped);
}

TEST_CASE(
    "gpu particles: those of another emitter give birth to them as to the CPU's"
    * technique("particle.gpu-init")) {
    for (const ParticleMoment at :
         {ParticleMoment::Birth, ParticleMoment::Flight, ParticleMoment::Hit,
          ParticleMoment::Death}) {
        CAPTURE(static_cast<int>(at));
        ParticleEmitter emitter = fountain();
        emitter.rate = 30;
        emitter.life = 1.5f;
        emitter.shape = EmitterShape::Ball;
        emitter.size = Vec3(0.1f);
        Executors both(emitter, {.gravity = 0.3f});
        ParticleEmitter parent = fountain();
        parent.rate = 60;
        parent.life = 0.7f;
        parent.life_spread = 0.2f;
        const Affine pose = affine_from({1, 1, 3}, Quat(1, 0, 0, 0), Vec3(1));
        const Entity source = both.world.create(
            parent, ParticleMotion{.gravity = 1.5f}, WorldTransform{pose},
            PreviousWorldTransform{pose}, ParticleCollision{.bounce = 0.4f});
        both.add_obstacle(
            {.shape = ColliderShape::Plane}, {0, 0.9f, 0}, Quat(0.98f, 0.1f, 0, 0.1f));
        for (const Entity entity : {both.cpu, both.gpu}) {
            both.world.add(
                entity, ParticleSource{.emitter = source, .at = at, .count = 3, .inherit = 0.5f});
        }
        both.world.run(add_particle_pools);
        both.step(120);
        const std::vector<GpuParticle> gpu = both.read();
        REQUIRE(gpu.size() == both.pool().size());
        CHECK(gpu.size() > 100);
        CHECK(largest_distance(gpu, both.pool(), 6) < 1e-4f);
        CHECK(both.recorded().clock.born == both.pool().clock.born);
    }
}

TEST_CASE(
    "gpu particles: drops that waves throw up fly as the CPU's, up to the capacity"
    * technique("particle.gpu-init, water.crest-spray")) {
    ParticleEmitter emitter = fountain();
    emitter.rate = 100;
    emitter.capacity = 1500;
    emitter.drop_speed = 1.3f;
    emitter.life = 3;
    Executors both(emitter, {.drag = 0.5f});
    for (const Entity entity : {both.cpu, both.gpu}) {
        both.world.add(entity, SprayDrops{});
    }
    for (int i = 0; i < 100; ++i) {
        SprayDrops drops;
        for (int k = 0; k < i % 30; ++k) {
            drops.drops.push_back(
                {{0.1f * static_cast<float>(k), 2, 0.03f * static_cast<float>(i)},
                 {1, 0.2f * static_cast<float>(k), -2}});
        }
        both.world.get<SprayDrops>(both.cpu) = drops;
        both.world.get<SprayDrops>(both.gpu) = drops;
        both.step();
    }
    const std::vector<GpuParticle> gpu = both.read();
    REQUIRE(gpu.size() == both.pool().size());
    CHECK(gpu.size() == 1500);
    CHECK(both.recorded().clock.dropped > 10);
    CHECK(both.recorded().clock.dropped == both.pool().clock.dropped);
    CHECK(largest_distance(gpu, both.pool(), 10) < 1e-4f);
}

/// `count` particles at rest in a ball of 1 m.
ParticleEmitter still_ball(int count) {
    ParticleEmitter emitter;
    emitter.rate = 0;
    emitter.bursts = {{.time = 0, .count = static_cast<float>(count)}};
    emitter.capacity = count;
    emitter.shape = EmitterShape::Ball;
    emitter.size = {1, 1, 1};
    emitter.speed = emitter.speed_spread = 0;
    emitter.life = 100;
    return emitter;
}

TEST_CASE(
    "gpu particles: those that cover are drawn from back to front, as the CPU's are"
    * technique("particle.distance-sort")) {
    Executors both(still_ball(3000), {.gravity = 0});
    both.step(2);
    both.shine(PointLight{.intensity = 20, .radius = 9}, at({3, 4, 3.5f}));
    ParticleLook puff;
    puff.size = 0.5f;
    puff.colors = {{.at = 0, .color = {1, 1, 1}, .opacity = 0.9f}};
    const RenderView view = both.look({3, 3, 6}, {1, 2, 3}, 48, 32);
    const auto drawn_by = [&](Entity entity, ParticleSort sort) {
        puff.sort = sort;
        both.world.add(entity, ParticleLook(puff));
        gpu::FloatImage image = both.radiance(view);
        both.world.remove<ParticleLook>(entity);
        return image;
    };
    const gpu::FloatImage cpu = drawn_by(both.cpu, ParticleSort::Distance);
    const float brightest = *std::max_element(cpu.pixels.begin(), cpu.pixels.end());
    CHECK(largest_difference(drawn_by(both.gpu, ParticleSort::Distance), cpu) < 0.01f * brightest);
    CHECK(largest_difference(drawn_by(both.gpu, ParticleSort::Amortized), cpu) < 0.01f * brightest);
    const gpu::FloatImage unsorted = drawn_by(both.gpu, ParticleSort::Births);
    CHECK(largest_difference(unsorted, cpu) > 0.05f * brightest);
    CHECK(
        largest_difference(drawn_by(both.cpu, ParticleSort::Births), unsorted) < 0.01f * brightest);
    CHECK(largest_difference(drawn_by(both.cpu, ParticleSort::Distance), cpu) == 0);  // alone again
}

TEST_CASE(
    "gpu particles: in water and above it they are drawn as the CPU's are"
    * technique("particle.distance-sort")) {
    Executors both(still_ball(60), {.gravity = 0});
    both.step(2);
    both.place(
        both.add(make_square()), both.add(Material{.base_color = {0, 0, 0, 1}, .roughness = 1}),
        affine_from({1, 0, 3}, Quat(std::sqrt(0.5f), -std::sqrt(0.5f), 0, 0), Vec3(9)));
    const Entity water = both.world.create(
        Water{
            .size = {16, 16}, .depth = 2, .absorption = {0.5f, 0.2f, 0.1f}, .scattering = Vec3(0)},
        WorldTransform{at({1, 2, 3})});
    ParticleLook speck;
    speck.size = 1;
    speck.colors = {{.at = 0, .color = {1, 1, 1}, .opacity = 0.9f}};
    speck.emission = 1;
    speck.lit = 0;
    const RenderView view = both.look({1, 6, 4}, {1, 2, 3}, 64, 48);
    const auto drawn_by = [&](Entity entity) {
        both.world.add(entity, ParticleLook(speck));
        gpu::FloatImage image = both.radiance(view);
        both.world.remove<ParticleLook>(entity);
        return image;
    };
    const gpu::FloatImage cpu = drawn_by(both.cpu);
    CHECK(largest_difference(drawn_by(both.gpu), cpu) < 1e-5f);
    both.world.get<Water>(water).absorption = Vec3(1000);  // those in it are invisible
    CHECK(largest_difference(drawn_by(both.gpu), cpu) > 0.3f);
}

TEST_CASE(
    "gpu particles: in the light of a sun or a spot their shadows are those of the CPU's"
    * technique("particle.gpu-shadow")) {
    for (const bool in_spot : {false, true}) {
        CAPTURE(in_spot);
        ParticleEmitter emitter = fountain();
        emitter.rate = 0;
        emitter.bursts = {{.time = 0, .count = 60}};
        emitter.shape = EmitterShape::Ball;
        emitter.size = {1, 1, 1};
        emitter.speed = emitter.speed_spread = 0;
        emitter.life = 100;
        Executors both(emitter, {.gravity = 0});
        both.step(2);
        both.place(
            both.add(make_square()), both.add(Material{.base_color = {1, 1, 1, 1}, .roughness = 1}),
            affine_from({1, 2, 1}, {1, 0, 0, 0}, Vec3(3)));
        if (in_spot) {
            both.world.create(
                SpotLight{.intensity = 80, .radius = 20, .inner_angle = 0.5f, .outer_angle = 0.6f},
                Shadow{}, WorldTransform{at({1, 2, 7})});
        } else {
            both.shine(
                DirectionalLight{.illuminance = 3},
                affine_from({0, 0, 9}, glm::angleAxis(0.3f, Vec3(0, 1, 0)), Vec3(1)));
        }
        ParticleLook puff;
        puff.size = 0.5f;
        puff.size_spread = 0.2f;
        puff.colors = {{.at = 0, .color = {1, 1, 1}, .opacity = 0.6f}};
        puff.near_fade = 1000;  // invisible, but for its shadow
        puff.shadow = 1;
        const RenderView view = both.look({1, 2, 4}, {1, 2, 1}, 64, 64);
        const auto shadowed_by = [&](Entity entity) {
            both.world.add(entity, ParticleLook(puff));
            gpu::FloatImage image = both.radiance(view);
            both.world.remove<ParticleLook>(entity);
            return image;
        };
        const gpu::FloatImage open = both.radiance(view);
        const float brightest = *std::max_element(open.pixels.begin(), open.pixels.end());
        const gpu::FloatImage cpu = shadowed_by(both.cpu);
        const gpu::FloatImage gpu = shadowed_by(both.gpu);
        CHECK(largest_difference(cpu, open) > 0.3f * brightest);
        CHECK(largest_difference(gpu, cpu) < 0.02f * brightest);
        // With casters of both kinds the light that is left is about the square.
        both.world.add(both.cpu, ParticleLook(puff));
        const gpu::FloatImage twice = shadowed_by(both.gpu);
        both.world.remove<ParticleLook>(both.cpu);
        float worst = 0;
        for (std::size_t i = 0; i < open.pixels.size(); i += 4) {
            if (open.pixels[i] > 0.05f * brightest) {
                const float left = cpu.pixels[i] / open.pixels[i];
                worst = std::max(worst, std::abs(twice.pixels[i] / open.pixels[i] - left * left));
            }
        }
        CHECK(worst < 0.05f);
    }
}

TEST_CASE("gpu particles: no number makes a NaN, a hang or more than fits") {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInf = std::numeric_limits<float>::infinity();
    for (const float bad : {kNan, kInf, -kInf, 1e9f, -1e9f, 0.0f}) {
        CAPTURE(bad);
        for (int field = 0; field < 10; ++field) {
            CAPTURE(field);
            ParticleEmitter emitter = fountain();
            emitter.bursts = {{.time = 0.05f, .count = 10}};
            emitter.duration = 0.5f;
            emitter.shape = EmitterShape::Ball;
            ParticleMotion motion;
            motion.turbulence = 1;
            float* const fields[] = {
                &emitter.rate, &emitter.rate_spread,   &emitter.life,     &emitter.speed,
                &emitter.cone, &emitter.size.y,        &emitter.duration, &emitter.bursts[0].count,
                &motion.drag,  &motion.turbulence_size};
            *fields[field] = bad;
            Executors both(emitter, motion);
            both.step(30);
            const std::vector<GpuParticle> alive = both.read();
            CHECK(alive.size() <= emitter.capacity);
            bool all_finite = true;
            for (const GpuParticle& one : alive) {
                const Vec3 sum = Vec3(one.position_age) + Vec3(one.velocity_life);
                all_finite = all_finite && std::isfinite(sum.x + sum.y + sum.z);
            }
            CHECK(all_finite);
        }
    }
}

TEST_CASE("gpu particles: a world that is loaded again keeps nothing of the previous one") {
    Executors first(fountain(), {});
    first.step(30);
    REQUIRE(first.read().size() == 200);
    // The same entities after as many steps, but nothing falls.
    Executors second(fountain(), {.gravity = 0});
    second.step(30);
    std::swap(first.pools, second.pools);
    const std::vector<GpuParticle> found = second.read();
    REQUIRE(found.size() == second.pool().size());
    CHECK(largest_distance(found, second.pool(), 3 * 0.5f) < 1e-4f);
}

TEST_CASE(
    "gpu particles: initial values are within their spread, their mean is the mean"
    * technique("particle.gpu-init")) {
    ParticleEmitter emitter = fountain();
    emitter.rate = 0;
    emitter.bursts = {{.time = 0, .count = 1 << 20}};
    emitter.capacity = 1 << 20;
    emitter.shape = EmitterShape::Box;
    emitter.size = {10, 1, 10};
    emitter.speed = 3;
    emitter.speed_spread = 1;
    emitter.life = 10;
    emitter.life_spread = 2;
    ParticleMotion still;
    still.gravity = 0;
    Executors both(emitter, still);
    both.world.destroy(both.cpu);
    both.step();
    const std::vector<GpuParticle> all = both.read();
    REQUIRE(all.size() == 1u << 20);
    double life = 0;
    double speed = 0;
    double product = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const float length = glm::length(Vec3(all[i].velocity_life));
        REQUIRE(std::abs(length - 3) <= 1.001f);
        REQUIRE(std::abs(all[i].velocity_life.w - 10) <= 2.001f);
        life += static_cast<double>(all[i].velocity_life.w);
        speed += static_cast<double>(length);
        product += static_cast<double>(all[i].velocity_life.w - 10)
                   * static_cast<double>(all[(i + 1) % all.size()].velocity_life.w - 10);
    }
    const auto count = static_cast<double>(all.size());
    CHECK(life / count == near(10).epsilon(0.005));
    CHECK(speed / count == near(3).epsilon(0.005));
    CHECK(std::abs(product / count / (4.0 / 3)) < 0.01);  // of neighbors: no correlation
}

}  // namespace limn::test::gpu_particle_test
