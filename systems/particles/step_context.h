#pragma once

#include "ecs/base/math.h"
#include "ecs/components/camera.h"
#include "ecs/components/force_field.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/weather.h"
#include "ecs/param_group.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/particles/emitter_pose.h"

#include <cstdint>
#include <vector>

namespace limn {

// What all emitters share in a step, whether the CPU or the GPU simulates them.

/// The queries and resources that find_step_context() reads, as one parameter of a system.
struct ParticleEnvironment {
    Query<const ForceField, const WorldTransform> fields;
    Query<const Camera, const WorldTransform> cameras;
    Res<const WeatherState> gusts;
    OptionalRes<const Weather> weather;
    Res<const RandomSeed> seed;
    Res<const FrameTime> time;
};

template <>
struct SystemParam<ParticleEnvironment>
    : ParamGroup<
          ParticleEnvironment, Query<const ForceField, const WorldTransform>,
          Query<const Camera, const WorldTransform>, Res<const WeatherState>,
          OptionalRes<const Weather>, Res<const RandomSeed>, Res<const FrameTime>> {};

struct StepContext {
    float dt = 0;               ///< length of the step, at most kMaxParticleStep [s]
    FrameTime time{};           ///< at its end
    std::uint64_t seed = 0;     ///< of all random numbers
    Vec3 wind = {0, 0, 0};      ///< [m/s]
    std::vector<Force> forces;  ///< of all force fields
    Viewpoint eye{};            ///< the active camera
};
[[nodiscard]] StepContext find_step_context(const ParticleEnvironment& environment);

/// What moves the particles of an emitter at `world`. `motion` and `wrap` may be null.
[[nodiscard]] MotionStep find_emitter_motion(
    const ParticleMotion* motion, const ParticleWrap* wrap, const Affine& world,
    const StepContext& context);

/// Wraps the particles around the camera if `wrap` is not null and their positions are integrated.
void set_wrap(MotionStep& motion, const ParticleWrap* wrap, const StepContext& context);

}  // namespace limn
