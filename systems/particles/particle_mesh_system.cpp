#include "systems/particles/particle_mesh_system.h"

#include "systems/particles/surface_births.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

// Techniques: engine.explode, engine.projectile-instances, particle.mesh-particles

namespace limn {
namespace {

constexpr float kMinScale = 1e-4f;      // so that normals have a direction
constexpr float kMeshRestSpeed = 1.0f;  // below which colliding particles spin less [m/s]
constexpr float kMinSpeed = 1e-4f;      // below which a velocity has no direction [m/s]

/// As random_signed() of lib/particle.glsl, but 0 .. 1: a random number for each index.
float random_fraction(std::uint32_t bits, std::uint32_t index) {
    std::uint32_t h = (bits + index * 0x9e3779b9u) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    return static_cast<float>(h >> 8) * 0x1p-24f;
}

enum : std::uint32_t { kScale = 8, kSpin, kAngle, kAxisZ, kAxisTurn, kMesh };

float give_or_take(float mean, float spread, std::uint32_t bits, std::uint32_t index) {
    return mean + spread * (2 * random_fraction(bits, index) - 1);
}

Vec3 axis_of(std::uint32_t bits) {
    const float z = 2 * random_fraction(bits, kAxisZ) - 1;
    const float turn = 2 * kPi * random_fraction(bits, kAxisTurn);
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

/// Rotation, scale and shear of `world`, about a point.
Affine about(const Affine& world, const Vec3& position, const Quat& turn, float scale) {
    return affine_from(position, turn, Vec3(scale)) * moved_to(world, Vec3(0));
}

MeshId mesh_of_particles(const ParticleMesh& mesh, const MeshData* whole, std::uint32_t key) {
    if (whole != nullptr) {
        const std::uint32_t piece = key & kPieceMask;
        return piece < whole->pieces.size() ? whole->pieces[piece].mesh : MeshId{};
    }
    if (mesh.meshes.empty()) {
        return {};
    }
    const float pick = random_fraction(key, kMesh) * static_cast<float>(mesh.meshes.size());
    return mesh.meshes[std::min(static_cast<std::size_t>(pick), mesh.meshes.size() - 1)];
}

/// What is the same for all particles of an emitter in a step.
struct MeshStep {
    Affine world{};                   ///< of the emitter
    const MeshData* whole = nullptr;  ///< whose pieces they are, or null
    bool collides = false;
    float dt = 0;
};

/// `old`: the same one a step earlier, null if it is new.
MeshParticle step_instance(
    const ParticleMesh& mesh, const ParticlePool& pool, std::size_t i, const MeshStep& step,
    const MeshParticle* old) {
    const float dt = step.dt;
    const std::uint32_t key = pool.look[i];
    const Vec3 position = {pool.x[i], pool.y[i], pool.z[i]};
    const Vec3 velocity = {pool.vx[i], pool.vy[i], pool.vz[i]};
    const float speed = glm::length(velocity);
    const bool stuck = i < pool.stuck.size() && pool.stuck[i] != 0;
    const float free = stuck ? 0.0f : step.collides ? std::min(speed / kMeshRestSpeed, 1.0f) : 1.0f;
    const float spin = give_or_take(mesh.spin, mesh.spin_spread, key, kSpin);
    MeshParticle moved;
    moved.key = key;
    moved.mesh = mesh_of_particles(mesh, step.whole, key);
    const bool as_emitter = mesh.facing == ParticleMeshFacing::Emitter;
    const float begin = as_emitter ? 0.0f : 2 * kPi * random_fraction(key, kAngle);
    moved.angle = old != nullptr ? old->angle + free * spin * dt : begin + spin * pool.age[i];
    const float life_fraction = std::clamp(pool.age[i] / std::max(pool.life[i], 1e-6f), 0.0f, 1.0f);
    const float left = pool.life[i] - pool.age[i];
    const float shrunk = mesh.fade > 0 ? std::clamp(left / mesh.fade, 0.0f, 1.0f) : 1.0f;
    const float scale = std::max(
        give_or_take(mesh.scale, mesh.scale_spread, key, kScale)
            * sample_curve(mesh.scale_curve, life_fraction) * shrunk,
        kMinScale);
    const bool flies = mesh.facing == ParticleMeshFacing::Velocity;
    if (old != nullptr && (stuck || (flies && !(speed > kMinSpeed)))) {
        moved.now = moved_to(old->now, position);
    } else {
        const Quat turned = flies && speed > kMinSpeed ? toward(velocity, moved.angle)
                                                       : glm::angleAxis(moved.angle, axis_of(key));
        moved.now = as_emitter ? about(step.world, position, turned, scale)
                               : affine_from(position, turned, Vec3(scale));
    }
    moved.before = old != nullptr
                       ? old->now
                       : moved_to(moved.now, position - velocity * std::min(pool.age[i], dt));
    return moved;
}

}  // namespace

void add_particle_mesh_states(
    Query<const ParticleMesh, Without<ParticleMeshState>> meshes, Commands commands) {
    meshes.each(
        [&](Entity entity, const ParticleMesh&) { commands.add(entity, ParticleMeshState{}); });
}

void update_particle_meshes(
    Query<
        const ParticleMesh, const ParticlePool, const WorldTransform,
        Optional<const ParticleSurface>, Optional<const ParticleCollision>, ParticleMeshState>
        meshes,
    Res<const Assets> assets, Res<const FrameTime> time) {
    meshes.each([&](const ParticleMesh& mesh, const ParticlePool& pool,
                    const WorldTransform& transform, const ParticleSurface* surface,
                    const ParticleCollision* collision, ParticleMeshState& state) {
        MeshStep step{.world = transform.world, .collides = collision != nullptr, .dt = time->step};
        if (surface != nullptr && surface->on == BirthSurface::Pieces && !mesh.meshes.empty()
            && mesh.meshes[0].index < assets->meshes.size()) {
            step.whole = &assets->meshes[mesh.meshes[0].index];
        }
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
            list[i] = step_instance(mesh, pool, i, step, next < known ? &old : nullptr);
            ++next;
        }
        list.resize(pool.size());
    });
}

}  // namespace limn
