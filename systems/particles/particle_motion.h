#pragma once

#include "ecs/base/math.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "systems/particles/particle_kernels.h"

#include <cstddef>
#include <span>

namespace limn {

/// Longest step that is simulated [s]; longer ones are clamped.
inline constexpr float kMaxParticleStep = 0.1f;

/// `world` is the emitter's, `weather` the velocity of the wind [m/s], `forces` those of the
/// fields, `dt` the step [s]. Numbers that are not finite count as 0.
[[nodiscard]] MotionStep find_motion(
    const ParticleMotion& motion, const Affine& world, const Vec3& weather,
    std::span<const Force> forces, float dt, const FrameTime& time);

/// Moves axes and origins to an emitter at `world`; the rest of the motion stays.
void orient_motion(MotionStep& motion, const Affine& world);

/// Moves particles by a step; returns how many have reached the end of life.
std::size_t move_block(const MotionStep& motion, const ParticleBlock& block);

}  // namespace limn
