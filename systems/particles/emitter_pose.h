#pragma once

#include "ecs/base/rng.h"
#include "ecs/components/camera.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/particles.h"
#include "ecs/components/transform.h"
#include "ecs/entity.h"
#include "ecs/query.h"

#include <cstdint>

namespace limn {

// Where an emitter is in a step, how large it appears in the image, and its random numbers: the
// same for both executors.

/// A new emitter has not moved.
[[nodiscard]] EmitterPose
emitter_pose(const WorldTransform& now, const PreviousWorldTransform& previous);

/// At the fraction `at` of the step: matrices a step apart differ little, so their elements are
/// interpolated.
[[nodiscard]] Affine interpolate_pose(const EmitterPose& pose, float at);

/// The camera that decides how large an emitter appears.
struct Viewpoint {
    Vec3 position = {0, 0, 0};
    float fov_y = 1;
};
[[nodiscard]] Viewpoint find_viewpoint(const Query<const Camera, const WorldTransform>& cameras);

/// Fraction 0 .. 1 of the image that the emitter's shape covers; 1 if its rate does not depend on
/// that.
[[nodiscard]] float
screen_coverage(const ParticleEmitter& emitter, const Affine& world, const Viewpoint& eye);

[[nodiscard]] std::uint64_t subject_of(const ParticleEmitter& emitter, Entity entity);

/// For the number of births in a step.
[[nodiscard]] Random births_random(std::uint64_t seed, std::uint64_t subject, std::uint64_t frame);

/// Whether the emitter has not started yet: then it is prewarmed.
[[nodiscard]] bool is_unused(const EmitterClock& clock);
/// Number of steps before the first one, at most a minute, and for the number of births in step i.
[[nodiscard]] int prewarm_steps(const ParticleEmitter& emitter, float dt);
[[nodiscard]] Random prewarm_random(std::uint64_t seed, std::uint64_t subject, int i);

/// For the attributes of birth `number`.
[[nodiscard]] Random
attributes_random(std::uint64_t seed, std::uint64_t subject, std::uint64_t number);
/// For its position on a ParticleSurface.
[[nodiscard]] Random
surface_random(std::uint64_t seed, std::uint64_t subject, std::uint64_t number);

}  // namespace limn
