// Particles of the GPU that meet what the camera saw.

#include "ecs/components/gpu_particles.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "ecs/components/weather.h"
#include "render/light/light_clusters.h"
#include "render/light/light_list.h"
#include "render/particles/gpu_particle_pools.h"
#include "render/view_block.h"
#include "systems/particles/gpu_particle_system.h"
#include "systems/particles/particle_obstacles.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace limn::test::particle_depth_test {
namespace {

constexpr float kDt = 1.0f / 60;
constexpr float kSkin = 1e-4f;  // as the shader keeps from surfaces [m]

/// A plane, as far as the camera sees it.
struct DepthWall {
    Vec3 normal;   ///< unit
    float offset;  ///< dot(normal, position) [m]
};

/// What a camera sees of a plane: no more than a texture and the camera's matrices.
struct DepthScene : Scene {
    RenderView camera = look({0, 2.5f, 6}, {0, 0.8f, 0}, 160, 120);
    gpu::Texture depth;
    gpu::RingBuffer ring{device().caps(), "steps", 1 << 20};
    GpuParticlePools pools = *GpuParticlePools::create(device());
    FrameGraph graph{device()};
    Entity emitter;

    DepthScene() {
        world.insert_resource(FrameTime{.step = kDt});
        world.insert_resource(RandomSeed{});
        world.insert_resource(WeatherState{});
        world.insert_resource(ParticleObstacles{});
        world.insert_resource(GpuShapes{});
    }
    /// `holes`: columns of pixels from here on see nothing.
    void see(const DepthWall& wall, int holes = 1 << 20) {
        const auto& rows = camera.world_from_camera.row;
        const auto column = [&](int c) { return Vec3(rows[0][c], rows[1][c], rows[2][c]); };
        std::vector<float> pixels;
        for (int y = 0; y < camera.height; ++y) {
            for (int x = 0; x < camera.width; ++x) {
                const Vec2 ndc =
                    (Vec2(x, y) + 0.5f) / Vec2(camera.width, camera.height) * 2.0f - 1.0f;
                const Vec3 ray = -column(2) + ndc.x * camera.tangent.x * column(0)
                                 + ndc.y * camera.tangent.y * column(1);
                const float distance =
                    (wall.offset - glm::dot(wall.normal, column(3))) / glm::dot(wall.normal, ray);
                pixels.push_back(distance > 0 && x < holes ? camera.near / distance : 0.0f);
            }
        }
        depth = gpu::Texture(
            "previous depth", {.format = GL_R32F, .width = camera.width, .height = camera.height});
        depth.upload<float>(pixels, GL_RED, GL_FLOAT);
    }
    void emit(ParticleEmitter settings, const ParticleCollision& collision, const Vec3& position) {
        settings.executor = ParticleExecutor::Gpu;
        settings.seed = 5;
        emitter = world.create(
            settings, ParticleMotion{}, collision, WorldTransform{at(position)},
            PreviousWorldTransform{at(position)});
        world.run(add_gpu_particles);
    }
    /// A step, and the states on the GPU: positions and ages, velocities and lifetimes.
    std::vector<Vec4> step() {
        FrameTime& time = world.resource<FrameTime>();
        time.time += static_cast<double>(time.step);
        ++time.frame;
        world.run(record_gpu_particles);
        FrameData frame;
        frame.ring = &ring;
        frame.device = &device();
        ring.begin_frame();
        pools.begin_frame(world);
        pools.add(
            frame, emitter, world.get<const ParticleEmitter>(emitter),
            world.get<GpuParticles>(emitter), 0, std::nullopt,
            &world.get<const ParticleCollision>(emitter));
        const PreviousDepth previous = {
            &depth, ring.push_value(make_view_block(camera, ClusterShape{}, LightList{}, false))};
        graph.begin_frame();
        pools.update(graph, {.depth = previous});
        graph.execute();
        ring.end_frame();
        const GpuParticlePool& pool = *pools.pools().begin()->second;
        std::vector<Vec4> slots(2 * static_cast<std::size_t>(pool.capacity));
        pool.state.read(0, std::as_writable_bytes(std::span(slots)));
        slots.resize(2 * static_cast<std::size_t>(pool.count));
        return slots;
    }
};

struct Ball {
    glm::dvec3 position;
    glm::dvec3 velocity;
};

/// Ten plain lines: a step under gravity, with as many rebounds from a plane as fit in it.
void step_ball(Ball& ball, const DepthWall& wall, const ParticleCollision& collision) {
    const glm::dvec3 normal(wall.normal);
    const glm::dvec3 old = ball.velocity;
    ball.velocity += glm::dvec3(0, -9.81, 0) * static_cast<double>(kDt);
    glm::dvec3 to = ball.position + 0.5 * (old + ball.velocity) * static_cast<double>(kDt);
    const auto above = [&](const glm::dvec3& p) {
        return glm::dot(normal, p) - static_cast<double>(wall.offset + collision.radius);
    };
    for (double left = static_cast<double>(kDt); above(to) < 0;) {
        const double fraction = above(ball.position) / (above(ball.position) - above(to));
        ball.position += fraction * (to - ball.position) + static_cast<double>(kSkin) * normal;
        const double toward = -glm::dot(normal, ball.velocity);
        const glm::dvec3 along = ball.velocity + toward * normal;
        ball.velocity =
            static_cast<double>(collision.friction) * along
            + (toward < 0.2 ? 0.0 : static_cast<double>(collision.bounce) * toward) * normal;
        left *= 1 - fraction;
        to = ball.position + left * ball.velocity;
    }
    ball.position = to;
}

ParticleEmitter handful() {
    ParticleEmitter settings;
    settings.rate = 0;
    settings.bursts = {{.time = 0, .count = 200}};
    settings.capacity = 256;
    settings.shape = EmitterShape::Ball;
    settings.size = Vec3(0.5f);
    settings.speed = 0.8f;
    settings.cone = kPi;
    settings.life = 20;
    return settings;
}

}  // namespace

TEST_CASE_FIXTURE(
    DepthScene, "particle depth: off a visible plane they bounce as ten plain lines of C++ say"
                    * technique("particle.depth-collision")) {
    for (const float radius : {0.0f, 0.04f}) {
        CAPTURE(radius);
        const DepthWall wall = {glm::normalize(Vec3(0.15f, 1, 0.2f)), 0.1f};
        see(wall);
        const ParticleCollision collision = {
            .bounce = 0.6f, .friction = 0.8f, .radius = radius, .collide_depth = 0.2f};
        emit(handful(), collision, {0, 1.4f, 0});
        std::vector<Ball> balls;
        double worst = 0;
        std::size_t rebounds = 0;
        for (int i = 0; i < 60; ++i) {
            const std::vector<Vec4> found = step();
            if (i == 0) {
                for (std::size_t k = 0; k < found.size(); k += 2) {
                    balls.push_back({glm::dvec3(found[k]), glm::dvec3(found[k + 1])});
                }
                continue;
            }
            REQUIRE(found.size() == 2 * balls.size());
            for (std::size_t k = 0; k < balls.size(); ++k) {
                const double falling = balls[k].velocity.y;
                step_ball(balls[k], wall, collision);
                rebounds += falling < -0.5 && balls[k].velocity.y > falling + 0.5 ? 1 : 0;
                worst = std::max(worst, glm::distance(balls[k].position, glm::dvec3(found[2 * k])));
            }
        }
        CHECK(balls.size() == 200);
        CHECK(rebounds > 200);
        CHECK(worst < 2e-3);
        world.destroy(emitter);
        pools = *GpuParticlePools::create(device());
    }
}

TEST_CASE_FIXTURE(
    DepthScene, "particle depth: what the camera did not see, or is thinner, does not stop them"
                    * technique("particle.depth-collision")) {
    const DepthWall wall = {{0, 1, 0}, 0};
    const ParticleCollision collision = {
        .action = CollisionAction::Stick, .radius = 0, .collide_depth = 0.1f};
    // The right half of the image is empty.
    see(wall, camera.width / 2);
    ParticleEmitter drops = handful();
    drops.speed = drops.speed_spread = 0;
    emit(drops, collision, {0, 1.2f, 0});
    std::vector<Vec4> found;
    for (int i = 0; i < 90; ++i) {
        found = step();
    }
    std::size_t held = 0;
    for (std::size_t k = 0; k < found.size(); k += 2) {
        const bool is_held = std::abs(found[k].y) < 2e-3f;
        CAPTURE(found[k].x);
        held += is_held ? 1 : 0;
        CHECK(is_held != (found[k].y < -1));
        if (std::abs(found[k].x) > 0.05f) {  // wider than a pixel
            CHECK(is_held == (found[k].x < 0));
        }
    }
    CHECK(held > 40);
    CHECK(held < 160);
    world.destroy(emitter);
    // Behind the visible surface, by more than its thickness, they fall freely.
    pools = *GpuParticlePools::create(device());
    see(wall);
    emit(handful(), collision, {0, -1, 0});
    for (int i = 0; i < 30; ++i) {
        found = step();
    }
    for (std::size_t k = 0; k < found.size(); k += 2) {
        CHECK(found[k].y < -1.5f);
    }
}

TEST_CASE_FIXTURE(DepthScene, "particle depth: balls deeper than the thickness fall freely") {
    see({{0, 1, 0}, 0});
    ParticleEmitter balls = handful();
    balls.size = Vec3(0.02f);
    balls.speed = balls.speed_spread = 0;
    emit(balls, {.radius = 0.1f, .collide_depth = 0.1f}, {0, -0.3f, 0});
    std::vector<Vec4> found;
    for (int i = 0; i < 30; ++i) {
        found = step();
    }
    REQUIRE(found.size() == 400);
    for (std::size_t k = 0; k < found.size(); k += 2) {
        CHECK(found[k].y < -1);
    }
}

TEST_CASE_FIXTURE(
    DepthScene, "particle depth: at 60 m/s none passes a visible surface"
                    * technique("particle.depth-collision")) {
    const DepthWall wall = {glm::normalize(Vec3(0, 0.5f, 1)), -1};
    see(wall);
    ParticleEmitter settings = handful();
    settings.speed = 60;
    settings.speed_spread = 0;
    settings.cone = 0.2f;
    const Affine aim = affine_from({0, 1.5f, 2}, glm::angleAxis(-1.9f, Vec3(1, 0, 0)), Vec3(1));
    emit(settings, {.action = CollisionAction::Stick, .collide_depth = 0.1f}, {0, 1.5f, 2});
    world.get<WorldTransform>(emitter).world = aim;
    world.get<PreviousWorldTransform>(emitter).world = aim;
    std::vector<Vec4> found;
    for (int i = 0; i < 30; ++i) {
        found = step();
    }
    REQUIRE(found.size() == 400);
    std::size_t held = 0;
    for (std::size_t k = 0; k < found.size(); k += 2) {
        const float above = glm::dot(wall.normal, Vec3(found[k])) - wall.offset;
        CHECK(above > -1e-3f);
        held += above < 0.02f ? 1 : 0;
    }
    CHECK(held == 200);
}

TEST_CASE_FIXTURE(
    DepthScene,
    "particle depth: no depth makes a NaN or a hang" * technique("particle.depth-collision")) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float value : {nan, 0.0f, -1.0f, 1e30f, 1e-30f}) {
        CAPTURE(value);
        see({{0, 1, 0}, 0});
        const std::vector<float> pixels(
            static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height),
            value);
        depth.upload<float>(pixels, GL_RED, GL_FLOAT);
        emit(handful(), {.collide_depth = 0.5f}, {0, 1, 0});
        for (int i = 0; i < 20; ++i) {
            for (const Vec4& one : step()) {
                CHECK(std::isfinite(glm::dot(one, Vec4(1))));
            }
        }
        world.destroy(emitter);
        pools = *GpuParticlePools::create(device());
    }
}

}  // namespace limn::test::particle_depth_test
