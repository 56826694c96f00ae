// Particles that are meshes: where each is, how it is turned, and where it was one step earlier.

#include "ecs/components/particle_collider.h"
#include "ecs/components/particle_mesh.h"
#include "systems/particles/particle_mesh_system.h"
#include "tests/near.h"
#include "tests/systems/particle_emitters.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace limn::test::particle_mesh_test {
namespace {

/// An emitter of meshes, moved step by step.
struct Meshes : Emitters {
    Entity emitter;

    Meshes(const ParticleEmitter& settings, const ParticleMesh& mesh, const ParticleMotion& motion)
        : emitter(add(settings, motion)) {
        world.add(emitter, ParticleMesh(mesh));
        world.run(add_particle_mesh_states);
    }
    const std::vector<MeshParticle>& step(int steps = 1) {
        for (int i = 0; i < steps; ++i) {
            run();
            world.run(update_particle_meshes);
        }
        return world.get<const ParticleMeshState>(emitter).instances;
    }
};

ParticleMesh three_meshes() {
    ParticleMesh mesh;
    mesh.meshes = {{0}, {1}, {2}};
    return mesh;
}

ParticleEmitter spray() {
    ParticleEmitter emitter = steady(300);
    emitter.cone = 1;
    emitter.speed = 4;
    emitter.speed_spread = 2;
    emitter.life = 0.5f;
    emitter.life_spread = 0.4f;
    return emitter;
}

Mat3 turn_of(const Affine& pose) {
    const auto column = [&](int i) { return Vec3(pose.row[0][i], pose.row[1][i], pose.row[2][i]); };
    return {column(0), column(1), column(2)};
}

bool is_same(const Affine& a, const Affine& b) {
    return a.row[0] == b.row[0] && a.row[1] == b.row[1] && a.row[2] == b.row[2];
}

/// Largest deviation of a rotation times `scale` from one.
float distortion(const Affine& pose, float scale) {
    const Mat3 turn = turn_of(pose);
    float largest = 0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            const float expected = i == j ? scale * scale : 0.0f;
            const float off = std::abs(glm::dot(turn[i], turn[j]) - expected);
            largest = off <= largest ? largest : off;  // NaN, too
        }
    }
    return largest;
}

}  // namespace

TEST_CASE(
    "particle meshes: as many instances as particles, each where its particle is"
    * technique("engine.projectile-instances, particle.mesh-particles")) {
    Meshes all(spray(), three_meshes(), falling());
    std::set<std::uint32_t> used;
    for (int i = 0; i < 90; ++i) {
        const std::vector<MeshParticle>& instances = all.step();
        const ParticlePool& pool = all.pool();
        REQUIRE(instances.size() == pool.size());
        for (std::size_t k = 0; k < pool.size(); ++k) {
            CHECK(
                transform_point(instances[k].now, Vec3(0))
                == Vec3(pool.x[k], pool.y[k], pool.z[k]));
            CHECK(instances[k].key == pool.look[k]);
            used.insert(instances[k].mesh.index);
        }
    }
    CHECK(all.pool().size() > 100);
    CHECK(used == std::set<std::uint32_t>{0, 1, 2});

    Meshes none(steady(0), three_meshes(), {});
    CHECK(none.step(10).empty());
}

TEST_CASE("particle meshes: an instance was where its particle was, whichever others die") {
    Meshes all(spray(), three_meshes(), falling());
    std::vector<MeshParticle> before = all.step(60);
    int found = 0;
    int born = 0;
    for (int i = 0; i < 60; ++i) {
        const std::vector<MeshParticle>& now = all.step();
        for (std::size_t k = 0; k < now.size(); ++k) {
            const auto old = std::find_if(before.begin(), before.end(), [&](const auto& one) {
                return one.key == now[k].key;
            });
            if (old != before.end()) {
                ++found;
                CHECK(is_same(now[k].before, old->now));
                CHECK(now[k].mesh.index == old->mesh.index);
            } else {
                ++born;  // less than a step ago, at the emitter
                CHECK(glm::length(transform_point(now[k].before, Vec3(0))) < 0.002f);
            }
        }
        before = now;
    }
    CHECK(found > 6000);
    CHECK(born == 300);
}

TEST_CASE(
    "particle meshes: turns keep lengths and angles, at a scale within its spread"
    * technique("particle.mesh-particles")) {
    ParticleMesh mesh = three_meshes();
    mesh.scale = 0.5f;
    mesh.scale_spread = 0.2f;
    mesh.scale_curve = {{.at = 0, .value = 1}, {.at = 1, .value = 2}};
    for (const ParticleMeshFacing facing :
         {ParticleMeshFacing::Tumble, ParticleMeshFacing::Velocity}) {
        mesh.facing = facing;
        Meshes all(spray(), mesh, falling());
        const std::vector<MeshParticle>& instances = all.step(60);
        const ParticlePool& pool = all.pool();
        float least = 10;
        float most = 0;
        for (std::size_t k = 0; k < instances.size(); ++k) {
            const float grown = 1 + pool.age[k] / pool.life[k];
            const float scale = glm::length(turn_of(instances[k].now)[0]);
            CHECK(distortion(instances[k].now, scale) < 1e-5f);
            CHECK(glm::determinant(turn_of(instances[k].now)) > 0);
            least = std::min(least, scale / grown);
            most = std::max(most, scale / grown);
        }
        CHECK(least > 0.2999f);
        CHECK(least < 0.33f);
        CHECK(most < 0.7001f);
        CHECK(most > 0.67f);
    }
}

TEST_CASE("particle meshes: they spin at their rate, about one axis each") {
    ParticleMesh mesh = three_meshes();
    mesh.spin = 3;
    mesh.spin_spread = 0;
    ParticleEmitter emitter = burst(200);
    emitter.cone = 3;
    Meshes all(emitter, mesh, {});
    const std::vector<MeshParticle> begin = all.step();
    const std::vector<MeshParticle>& end = all.step(30);
    Vec3 mean(0);
    for (std::size_t k = 0; k < end.size(); ++k) {
        const Mat3 turn = turn_of(end[k].now) * glm::transpose(turn_of(begin[k].now));
        const float angle = std::acos((turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2);
        CHECK(angle == near(1.5f).epsilon(1e-3));
        mean += Vec3(turn[1][2] - turn[2][1], turn[2][0] - turn[0][2], turn[0][1] - turn[1][0])
                / (2 * std::sin(angle) * static_cast<float>(end.size()));
    }
    CHECK(glm::length(mean) < 0.2f);  // the axes point everywhere
}

TEST_CASE("particle meshes: those that face their flight have -z along it, at any speed") {
    ParticleMesh mesh = three_meshes();
    mesh.facing = ParticleMeshFacing::Velocity;
    Meshes all(spray(), mesh, falling());
    const std::vector<MeshParticle>& instances = all.step(60);
    const ParticlePool& pool = all.pool();
    for (std::size_t k = 0; k < instances.size(); ++k) {
        const Vec3 velocity = {pool.vx[k], pool.vy[k], pool.vz[k]};
        const Vec3 forward = transform_vector(instances[k].now, Vec3(0, 0, -1));
        CHECK(glm::distance(forward, glm::normalize(velocity)) < 1e-5f);
    }
    // Straight up, where no direction is to the right, and at rest, where none is ahead.
    for (const float speed : {1.0f, 0.0f}) {
        ParticleEmitter emitter = steady(60);
        emitter.speed = speed;
        Meshes up(emitter, mesh, falling(0));
        for (const MeshParticle& one : up.step(10)) {
            CHECK(distortion(one.now, 1) < 1e-5f);
        }
    }
}

TEST_CASE("particle meshes: what sticks to a surface stops turning") {
    ParticleMesh mesh = three_meshes();
    mesh.spin = 5;
    Meshes all(burst(20), mesh, falling());
    all.world.add(all.emitter, ParticleCollision{.action = CollisionAction::Stick});
    all.world.create(
        ParticleCollider{}, WorldTransform{affine_from({0, -1, 0}, {1, 0, 0, 0}, Vec3(1))},
        PreviousWorldTransform{affine_from({0, -1, 0}, {1, 0, 0, 0}, Vec3(1))});
    const std::vector<MeshParticle> first = all.step(120);
    REQUIRE(first.size() == 20);
    const std::vector<MeshParticle>& later = all.step(30);
    for (std::size_t k = 0; k < later.size(); ++k) {
        CHECK(is_same(later[k].now, first[k].now));
    }
}

}  // namespace limn::test::particle_mesh_test
