#pragma once

#include "systems/particles/collider.h"
#include "systems/particles/collider_bounds.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Particles against static surfaces: the bump and friction response, and the loop that follows a
// path from contact to contact without losing time or passing through anything (book, chapter 8,
// "Particle Collisions", and appendix 8.2), for one particle and for the arrays of a pool.

/// Response of a surface, each 0 .. 1, clamped (table 8.1).
struct SurfaceResponse {
    float bounce = 0.3f;    ///< fraction of the normal speed kept, outward; "bump"
    float friction = 0.8f;  ///< fraction of the tangential velocity *kept*: 1 is frictionless
};

/// friction v_t - bounce v_n for a velocity toward the surface; others are unchanged. Never faster
/// than before. `normal` points outward and is normalized if need be.
[[nodiscard]] Vec3
respond(const Vec3& velocity, const Vec3& normal, const SurfaceResponse& response);

/// What a contact does to a particle.
enum class ContactAction : std::uint8_t {
    Bounce,  ///< responds and goes on
    Stick,   ///< stops
    Kill,    ///< stops and is marked as dead
};

struct CollisionOptions {
    /// What is left to move after a contact: the rest of the time at the new speed; or, as in the
    /// book, the rest of the path's length, whatever speed was lost.
    enum class Mode : std::uint8_t { Time, Length };

    int max_bounces = 8;      ///< in a step; then the particle stops
    float skin = 1e-4f;       ///< distance kept from surfaces [m]; more far from the origin
    float radius = 0;         ///< of the particle [m]
    float rest_speed = 0.2f;  ///< slower impacts neither rebound nor count as hits [m/s]
    Mode mode = Mode::Time;
    ContactAction action = ContactAction::Bounce;
};

struct CollisionResult {
    Vec3 position = Vec3(0);
    Vec3 velocity = Vec3(0);
    int contacts = 0;
};

/// Moves a particle by velocity * dt, dt >= 0 [s], responding to each contact along the path. Each
/// straight part of the path is tested against all colliders, so that a particle that is outside
/// stays outside, at any speed and however thin the wall. One that starts inside a solid is pushed
/// out and loses its speed toward the inside, but does not bounce. If position, velocity or dt is
/// not finite, it stays and stops.
[[nodiscard]] CollisionResult move_with_collisions(
    const Vec3& position, const Vec3& velocity, float dt, std::span<const Collider> colliders,
    const SurfaceResponse& response, const CollisionOptions& options = {});

/// Bits of the mark of a particle.
inline constexpr std::uint8_t kParticleHit = 1;     ///< hit something in this step
inline constexpr std::uint8_t kParticleStuck = 2;   ///< by ContactAction::Stick
inline constexpr std::uint8_t kParticleKilled = 4;  ///< by ContactAction::Kill

/// A step of particles, an array per scalar, all of the same size.
struct CollidingParticles {
    std::span<const float> x0{}, y0{}, z0{};  ///< where the step began [m]
    std::span<float> x{}, y{}, z{};           ///< where it ends if there is no contact [m]
    std::span<float> vx{}, vy{}, vz{};        ///< then [m/s]
    std::span<const float> radius{};          ///< [m]; empty: CollisionOptions::radius for all
    std::span<std::uint8_t> marks{};          ///< see collide_particles
    std::uint32_t first = 0;                  ///< number of the first particle, for hits
};

struct ParticleHit {
    std::uint32_t particle = 0;
    std::uint32_t collider = 0;
    Vec3 point = Vec3(0);     ///< center of the particle
    Vec3 normal = Vec3(0);    ///< unit, outward
    Vec3 velocity = Vec3(0);  ///< before the hit [m/s]
};

/// Colliders, with bounds that quickly reject those that a particle cannot touch.
struct ColliderSet {
    std::vector<Collider> colliders{};
    std::vector<ColliderBounds> bounds{};  ///< of each
};

/// Must be called when colliders or heights have changed; it reads all heights.
void set_colliders(ColliderSet& set, std::span<const Collider> colliders);

/// As move_with_collisions for each particle, along the given path until the first contact. Those
/// that touch nothing keep position and velocity. Writes each mark, and appends the hits in the
/// order of particles, those of one particle in the order of time; contacts slower than rest_speed
/// are no hits. That a particle starts inside a solid counts as a hit for the actions Stick and
/// Kill only.
///
/// Particles already marked as stuck or killed stay where they started, at rest: marks must be 0
/// at first. Particles do not influence each other: ranges may be processed in any order and in
/// blocks of any size, with the same bits on every machine. Allocates only to grow `hits`.
void collide_particles(
    const CollidingParticles& particles, float dt, const ColliderSet& set,
    const SurfaceResponse& response, const CollisionOptions& options,
    std::vector<ParticleHit>& hits);

}  // namespace limn
