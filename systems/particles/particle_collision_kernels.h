#pragma once

#include "systems/particles/particle_collision.h"

#include <cstddef>
#include <span>

namespace limn {

// Discrete collision after a step, for many particles: those found inside a solid are put on its
// surface and respond to it (Latta, "Building a Million Particle System", GDC 2004). Cheap, but a
// particle that crosses a thin solid within one step is missed; move_with_collisions, which is
// continuous, misses none. Each kernel has a
// SIMD version for the machine's widest vectors (Highway, dispatched at run time) and a plain C++
// one, `_scalar`, which also handles the remainder. Both perform the same operations in the same
// order, without fused multiply-add, so results are bit-identical on every machine.

/// Positions [m] and velocities [m/s], an array per scalar, all of the same size.
struct ParticleColumns {
    std::span<float> px, py, pz;
    std::span<float> vx, vy, vz;
};

/// As push_out and respond, for particles of `radius` >= 0 [m]. Those outside are rewritten only
/// if one in the same vector is inside. NaN is never inside.
void collide_plane(
    const ParticleColumns& particles, const PlaneCollider& plane, const SurfaceResponse& response,
    float radius = 0);
void collide_plane_scalar(
    const ParticleColumns& particles, const PlaneCollider& plane, const SurfaceResponse& response,
    float radius = 0);

void collide_sphere(
    const ParticleColumns& particles, const SphereCollider& sphere, const SurfaceResponse& response,
    float radius = 0);
void collide_sphere_scalar(
    const ParticleColumns& particles, const SphereCollider& sphere, const SurfaceResponse& response,
    float radius = 0);

/// The surface is raised by the radius, on slopes too. Up to 2^31 points.
void collide_height_field(
    const ParticleColumns& particles, const HeightCollider& field, const SurfaceResponse& response,
    float radius = 0);
void collide_height_field_scalar(
    const ParticleColumns& particles, const HeightCollider& field, const SurfaceResponse& response,
    float radius = 0);

}  // namespace limn
