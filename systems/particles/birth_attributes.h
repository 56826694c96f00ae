#pragma once

#include "ecs/base/math.h"
#include "ecs/base/rng.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/particles.h"

#include <cstdint>

namespace limn {

// What is drawn at random for one birth: position, velocity, life and look. These plain functions
// are the reference of birth_kernels.h, which draws many births at once and gets the same bits.
// Therefore angles, roots and powers are polynomials of our own: those of the C library differ from
// one version to the next.

/// Cosine and sine.
struct TurnPoint {
    float cosine;
    float sine;
};
/// Of 2 pi `fraction`, 0 <= fraction <= 1, within 2e-7.
[[nodiscard]] TurnPoint turn_point(float fraction);
/// Cube root of 0 <= x <= 1, within 2e-7 of it; below 1e-13 for 0.
[[nodiscard]] float cube_root(float x);
/// exp(x) for 0 <= x <= 1, within 4e-7 of it.
[[nodiscard]] float exp_of_fraction(float x);

/// A point of the emitter's shape in local space (particle.generation-shape).
[[nodiscard]] Vec3 sample_shape(EmitterShape shape, const Vec3& size, Random& random);
/// Unit: a direction within `cone` [rad] of +y, even by solid angle.
[[nodiscard]] Vec3 sample_cone(float cone, Random& random);
/// The lowest y of those directions.
[[nodiscard]] float lowest_of_cone(float cone);
/// The angle of the cone of directions; 0 for directions away from the center of the shape.
[[nodiscard]] float cone_of(const ParticleEmitter& emitter);

/// mean +- width
[[nodiscard]] float spread(float mean, float width, Random& random);

struct BirthAttributes {
    Vec3 local;     ///< position in the emitter's space
    Vec3 velocity;  ///< in world space
    float life;
    std::uint32_t look;
};
[[nodiscard]] BirthAttributes
draw_attributes(const ParticleEmitter& emitter, const Affine& world, Random& random);

/// Moves newborns back in time by a fraction of a step, along the path on which gravity and drag
/// will bring them here. Otherwise all births of a step would fall equally far, and jets would
/// break into clumps.
struct Rewind {
    explicit Rewind(const ParticleStep& step);

    /// By the fraction `at` of the step.
    void apply(float at, Vec3& position, Vec3& velocity) const;

    ParticleStep step;
    float drag;  ///< 0 .. 1: -log of the velocity that a whole step leaves
};

/// A particle before its first step.
struct Newborn {
    Vec3 position;
    Vec3 velocity;
    float age;  ///< at most 0: how much of the step's time is before its birth [s]
    float life;
    std::uint32_t look;

    [[nodiscard]] bool is_finite() const;
};

/// What the births of an emitter in a step have in common.
struct BirthDraw {
    const ParticleEmitter* emitter;
    EmitterPose pose;
    bool moves;  ///< whether the ends of that differ
    Rewind rewind;
    Vec3 added;  ///< to all velocities [m/s]
    std::uint64_t seed;
    std::uint64_t subject;
};

/// The birth `number` of the emitter, at the fraction `at` of the step.
[[nodiscard]] Newborn draw_birth(const BirthDraw& draw, float at, std::uint64_t number);

}  // namespace limn
