#include "ecs/components/all.h"
#include "ecs/components/particle_mesh.h"
#include "ecs/components/particles.h"
#include "ecs/components/rendering.h"
#include "ecs/components/time.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn::test::particle_velocity_test {
namespace {

constexpr int kSize = 96;
constexpr float kDt = 1.0f / 60;

/// A moving particle and a moving camera.
struct MovingParticle : Scene {
    glm::dvec3 where = {0.1, 0.2, 0};  ///< at the end of the step [m]
    glm::dvec3 velocity = {6, -3, 4};  ///< likewise [m/s]
    float age = 0.5f;
    ParticleMotion motion{.gravity = 0};
    ParticleLook look_;
    Affine eye = look_at({0, 0.3f, 3}, {0.1f, 0.2f, 0});
    Affine previous_eye = look_at({0.08f, 0.25f, 3.1f}, {0.05f, 0.22f, 0});
    Entity particle;

    MovingParticle() {
        world.insert_resource(FrameTime{.step = kDt, .time = 2, .frame = 120});
        look_.size = 0.5f;
        look_.lit = 0;
        look_.emission = 1;
        look_.softness = 0;
        look_.colors = {{.at = 0, .opacity = 1}};
    }
    RenderView view(float alpha, float previous_alpha) const {
        return make_render_view(
            {.fov_y = radians(60.0f), .near = 0.05f}, eye, previous_eye,
            {.width = kSize, .height = kSize, .alpha = alpha, .previous_alpha = previous_alpha});
    }
    void emit() {
        if (world.alive(particle)) {
            world.destroy(particle);
        }
        ParticlePool pool;
        const auto push = [](std::vector<float>& column, double value) {
            column.push_back(static_cast<float>(value));
        };
        push(pool.x, where.x);
        push(pool.y, where.y);
        push(pool.z, where.z);
        push(pool.vx, velocity.x);
        push(pool.vy, velocity.y);
        push(pool.vz, velocity.z);
        pool.age = {age};
        pool.life = {10};
        pool.look = {7};
        particle = world.create(ParticleEmitter{}, look_, motion, pool);
    }
    /// Where the drawn particle is in an image [px, right and down].
    static glm::dvec2 project(const Mat4& clip_from_world, const glm::dvec3& p) {
        const glm::dvec4 clip = glm::dmat4(clip_from_world) * glm::dvec4(p, 1);
        return {kSize * (0.5 + 0.5 * clip.x / clip.w), kSize * (0.5 - 0.5 * clip.y / clip.w)};
    }
    /// Velocity of the pixel at the center of the particle, less that of where it was and is.
    double error(const RenderView& view, const glm::dvec3& now, const glm::dvec3& before) {
        emit();
        const gpu::FloatImage found = aov(view, "velocity");
        const glm::dvec2 at = project(view.clip_from_world, now);
        const glm::dvec2 want = at - project(view.previous_clip_from_world, before);
        const glm::dvec2 got = {
            found.at(static_cast<int>(at.x), static_cast<int>(at.y), 0),
            found.at(static_cast<int>(at.x), static_cast<int>(at.y), 1)};
        return glm::distance(got, want);
    }
    double fastest(const RenderView& view) {
        emit();
        const gpu::FloatImage found = aov(view, "velocity");
        double most = 0;
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                most = std::max<double>(most, std::hypot(found.at(x, y, 0), found.at(x, y, 1)));
            }
        }
        return most;
    }
};

}  // namespace

TEST_CASE_FIXTURE(
    MovingParticle, "particle velocity: a particle moves as its projection does, to 0.05 px"
                        * technique("particle.velocity")) {
    for (const auto& frame :
         {std::pair(1.0f, 0.0f), std::pair(0.7f, 0.3f), std::pair(0.2f, -0.6f)}) {
        const float alpha = frame.first;
        const float before = frame.second;
        CAPTURE(alpha);
        const double back = (1.0 - static_cast<double>(alpha)) * static_cast<double>(kDt);
        const double earlier = (1.0 - static_cast<double>(before)) * static_cast<double>(kDt);
        const RenderView render_view = view(alpha, before);
        CHECK(error(render_view, where - velocity * back, where - velocity * earlier) <= 0.05);
    }
}

TEST_CASE_FIXTURE(
    MovingParticle, "particle velocity: falling and braking ones too, between steps as within one"
                        * technique("particle.velocity")) {
    motion.gravity = 1;
    motion.drag = 2;
    motion.wind = {3, 0, 0};
    const glm::dvec3 gravity = {0, -9.81, 0};
    const double dt = static_cast<double>(kDt);
    // The step that led here, backward: v' = air + (v + g dt - air) exp(-drag dt).
    const glm::dvec3 air = {3, 0, 0};
    const glm::dvec3 old = air + (velocity - air) / std::exp(-2 * dt) - gravity * dt;
    const glm::dvec3 begin = where - 0.5 * (old + velocity) * dt;
    const auto drawn = [&](double alpha) {
        return alpha > 0 ? where - velocity * ((1 - alpha) * dt) : begin + old * (alpha * dt);
    };
    for (const auto& frame :
         {std::pair(1.0f, 0.0f), std::pair(0.7f, 0.3f), std::pair(0.2f, -0.6f)}) {
        const float alpha = frame.first;
        const float before = frame.second;
        CAPTURE(alpha);
        CHECK(
            error(
                view(alpha, before), drawn(static_cast<double>(alpha)),
                drawn(static_cast<double>(before)))
            <= 0.05);
    }
}

TEST_CASE_FIXTURE(
    MovingParticle, "particle velocity: none in the first frame, at its birth, or after a cut"
                        * technique("particle.velocity")) {
    previous_eye = eye;
    CHECK(fastest(view(1, 0)) > 1);
    age = 0;
    CHECK(fastest(view(1, 0)) == 0);
    age = 0.5f;
    world.resource<FrameTime>().time = 0;
    CHECK(fastest(view(1, 0)) == 0);
    world.resource<FrameTime>().time = 2;
    // A camera that jumped adds no motion of its own.
    const double alone = fastest(view(1, 0));
    previous_eye = look_at({50, 0, 3}, {0, 0, 0});
    CHECK(fastest(view(1, 0)) == near(alone));
    // A box that sends it to its other side leaves its velocity.
    world.add(particle, ParticleWrap{.size = {1, 1, 1}});
    CHECK(fastest(view(1, 0)) == near(alone));
}

TEST_CASE_FIXTURE(
    MovingParticle, "particle velocity: only where it covers more than its look states"
                        * technique("particle.velocity")) {
    previous_eye = eye;
    look_.colors = {{.at = 0, .opacity = 0.4f}};
    CHECK(fastest(view(1, 0)) == 0);
    look_.velocity_cover = 0.3f;
    CHECK(fastest(view(1, 0)) > 1);
    look_.colors = {{.at = 0, .opacity = 1}};
    look_.velocity_cover = 0.5f;
    CHECK(fastest(view(1, 0)) > 1);
    look_.cover = 0.4f;  // adds light, mostly
    CHECK(fastest(view(1, 0)) == 0);
    look_.cover = 1;
    look_.velocity_cover = 1;
    CHECK(fastest(view(1, 0)) == 0);
    look_.velocity_cover = 0;
    look_.facing = ParticleFacing::Velocity;  // a streak
    CHECK(fastest(view(1, 0)) == 0);
    // A disc's opacity is (1 - r^2)^2: above a half up to 0.54 of its radius.
    look_.facing = ParticleFacing::Camera;
    look_.velocity_cover = 0.5f;
    velocity = {6, 0, 0};
    emit();
    const gpu::FloatImage found = aov(view(1, 0), "velocity");
    double moved = 0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            moved += found.at(x, y, 0) != 0 ? 1 : 0;
        }
    }
    const double radius = 0.25 * 0.5 * kSize / std::tan(radians(30.0f))
                          / glm::distance(Vec3(0, 0.3f, 3), Vec3(where));
    CHECK(moved == near(0.2929 * static_cast<double>(kPi) * radius * radius).epsilon(0.1));
    // Behind a surface it moves nothing.
    place(
        add(make_square()), add(Material{.double_sided = true}),
        affine_from({0, 0.2f, 1}, {1, 0, 0, 0}, Vec3(3)));
    CHECK(fastest(view(1, 0)) == 0);
}

}  // namespace limn::test::particle_velocity_test
