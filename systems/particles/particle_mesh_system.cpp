#include "systems/particles/particle_mesh_system.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr float kMinScale = 1e-4f;  // so that normals have a direction
constexpr float kRestSpeed = 1.0f;  // at which colliding particles begin to spin less [m/s]
constexpr float kMinSpeed = 1e-4f;  // that has a direction [m/s]

/// As in particle.vert: 0 .. 1, a number for each index.
float random_share(std::uint32_t bits, std::uint32_t index) {
    std::uint32_t h = (bits + index * 0x9e3779b9u) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    return static_cast<float>(h >> 8) * 0x1p-24f;
}

enum : std::uint32_t { kScale = 8, kSpin, kAngle, kAxisZ, kAxisTurn, kMesh };

float give_or_take(float mean, float spread, std::uint32_t bits, std::uint32_t index) {
    return mean + spread * (2 * random_share(bits, index) - 1);
}

Vec3 axis_of(std::uint32_t bits) {
    const float z = 2 * random_share(bits, kAxisZ) - 1;
    const float turn = 2 * kPi * random_share(bits, kAxisTurn);
    const float r = std::sqrt(std::max(1 - z * z, 0.0f));
    return {r * std::cos(turn), r * std::sin(turn), z};
}

Quat toward(const Vec3& velocity, float angle) {
    const Vec3 back = -glm::normalize(velocity);
    const Vec3 right = normalize_or(glm::cross(Vec3(0, 1, 0), back), Vec3(1, 0, 0));
    const Vec3 up = glm::cross(back, right);
    return glm::quat_cast(Mat3(right, up, back)) * glm::angleAxis(angle, Vec3(0, 0, 1));
}

Affine moved_to(const Affine& pose, const Vec3& position) {
    Affine moved = pose;
    for (int i = 0; i < 3; ++i) {
        moved.row[i].w = position[i];
    }
    return moved;
}

/// `old`: the same one a step earlier, null if it is new.
MeshParticle step_instance(
    const ParticleMesh& mesh, const ParticlePool& pool, std::size_t i, bool collides, float dt,
    const MeshParticle* old) {
    const std::uint32_t key = pool.look[i];
    const Vec3 position = {pool.x[i], pool.y[i], pool.z[i]};
    const Vec3 velocity = {pool.vx[i], pool.vy[i], pool.vz[i]};
    const float speed = glm::length(velocity);
    const bool stuck = i < pool.stuck.size() && pool.stuck[i] != 0;
    const float free = stuck ? 0.0f : collides ? std::min(speed / kRestSpeed, 1.0f) : 1.0f;
    const float spin = give_or_take(mesh.spin, mesh.spin_spread, key, kSpin);
    MeshParticle its;
    its.key = key;
    if (!mesh.meshes.empty()) {
        const float pick = random_share(key, kMesh) * static_cast<float>(mesh.meshes.size());
        its.mesh = mesh.meshes[std::min(static_cast<std::size_t>(pick), mesh.meshes.size() - 1)];
    }
    its.angle = old != nullptr ? old->angle + free * spin * dt
                               : 2 * kPi * random_share(key, kAngle) + spin * pool.age[i];
    const float share = std::clamp(pool.age[i] / std::max(pool.life[i], 1e-6f), 0.0f, 1.0f);
    const float scale = give_or_take(mesh.scale, mesh.scale_spread, key, kScale)
                        * sample_curve(mesh.scale_curve, share);
    const bool flies = mesh.facing == ParticleMeshFacing::Velocity;
    if (old != nullptr && (stuck || (flies && !(speed > kMinSpeed)))) {
        its.now = moved_to(old->now, position);
    } else {
        const Quat turned = flies && speed > kMinSpeed ? toward(velocity, its.angle)
                                                       : glm::angleAxis(its.angle, axis_of(key));
        its.now = affine_from(position, turned, Vec3(std::max(scale, kMinScale)));
    }
    its.before = old != nullptr
                     ? old->now
                     : moved_to(its.now, position - velocity * std::min(pool.age[i], dt));
    return its;
}

}  // namespace

void add_particle_mesh_states(
    Query<const ParticleMesh, Without<ParticleMeshState>> meshes, Commands commands) {
    meshes.each(
        [&](Entity entity, const ParticleMesh&) { commands.add(entity, ParticleMeshState{}); });
}

void update_particle_meshes(
    Query<
        const ParticleMesh, const ParticlePool, Optional<const ParticleCollision>,
        ParticleMeshState>
        meshes,
    Res<const FrameTime> time) {
    meshes.each([&](const ParticleMesh& mesh, const ParticlePool& pool,
                    const ParticleCollision* collision, ParticleMeshState& state) {
        std::vector<MeshParticle>& list = state.instances;
        const std::size_t known = list.size();
        std::size_t next = 0;
        // In place: the i-th particle was the i-th instance or a later one.
        list.resize(std::max(known, pool.size()));
        for (std::size_t i = 0; i < pool.size(); ++i) {
            while (next < known && (next < i || list[next].key != pool.look[i])) {
                ++next;
            }
            const MeshParticle old = next < known ? list[next] : MeshParticle{};
            list[i] = step_instance(
                mesh, pool, i, collision != nullptr, time->step, next < known ? &old : nullptr);
            ++next;
        }
        list.resize(pool.size());
    });
}

}  // namespace limn
