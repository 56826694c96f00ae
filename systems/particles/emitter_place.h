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

// Where an emitter is in a step, how large it appears, and whose random numbers it draws: the same
// for both executors.

/// One that is new has not moved.
[[nodiscard]] EmitterPlace
place_of(const WorldTransform& now, const PreviousWorldTransform& previous);

/// At the share `at` of the step: matrices a step apart differ little, their elements are mixed.
[[nodiscard]] Affine mix_places(const EmitterPlace& place, float at);

/// The camera that decides how large an emitter appears.
struct EmitterEye {
    Vec3 place = {0, 0, 0};
    float fov_y = 1;
};
[[nodiscard]] EmitterEye find_eye(const Query<const Camera, const WorldTransform>& cameras);

/// Share 0 .. 1 of its image that the emitter's shape covers; 1 if that does not count.
[[nodiscard]] float
seen_share(const ParticleEmitter& emitter, const Affine& world, const EmitterEye& eye);

[[nodiscard]] std::uint64_t subject_of(const ParticleEmitter& emitter, Entity entity);

/// Of how many are born in a step.
[[nodiscard]] Random births_random(std::uint64_t seed, std::uint64_t subject, std::uint64_t frame);

/// Whether nothing has happened yet: then it is prewarmed.
[[nodiscard]] bool is_unused(const EmitterClock& clock);
/// Steps before the first one, at most a minute of them, and the numbers of births in step i.
[[nodiscard]] int prewarm_steps(const ParticleEmitter& emitter, float dt);
[[nodiscard]] Random prewarm_random(std::uint64_t seed, std::uint64_t subject, int i);

/// Of the attributes of a birth, by its number.
[[nodiscard]] Random
attributes_random(std::uint64_t seed, std::uint64_t subject, std::uint64_t number);
/// Of its place on a ParticleSurface.
[[nodiscard]] Random
surface_random(std::uint64_t seed, std::uint64_t subject, std::uint64_t number);

}  // namespace limn
