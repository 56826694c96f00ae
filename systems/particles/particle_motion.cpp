#include "systems/particles/particle_motion.h"

#include "ecs/base/gravity.h"
#include "systems/particles/force_fields.h"
#include "systems/particles/particle_births.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

// Techniques: particle.forces, particle.gpu-update-mrt, particle.integrator,
//     particle.stateless-script

namespace limn {
namespace {

constexpr float kOrbitRate = 60.0f;          // steps per second for which `orbit` is defined [1/s]
const Vec3 kDriftA = {0.37f, 1.0f, -0.21f};  // of the fields of curl noise, by eye
const Vec3 kDriftB = {-0.29f, -0.6f, 0.43f};

constexpr float kMinDrag = 0.1f;  // from which the terminal velocity is small enough to add [1/s]

}  // namespace

MotionStep find_motion(
    const ParticleMotion& asked, const Affine& world, const Vec3& weather,
    std::span<const Force> forces, float dt, const FrameTime& time) {
    ParticleMotion motion = asked;
    for (float* const field :
         {&motion.gravity, &motion.drag, &motion.wind.x, &motion.wind.y, &motion.wind.z,
          &motion.weather, &motion.turbulence, &motion.turbulence_size, &motion.turbulence_speed,
          &motion.vortex, &motion.attraction, &motion.orbit, &motion.brake, &motion.fields}) {
        *field = finite_or(*field, 0);
    }
    const bool closed_form = motion.integrator == ParticleIntegrator::ClosedForm;
    if (closed_form) {
        motion = {.gravity = motion.gravity, .fields = 0};
    }
    MotionStep found;
    if (motion.fields != 0) {
        found.forces.assign(forces.begin(), forces.end());
        found.force_scale = motion.fields;
    }
    found.step = {
        .gravity = {0, -static_cast<float>(kGravity) * motion.gravity, 0},
        .air = motion.wind + motion.weather * weather,
        .keep = std::exp(-std::max(motion.drag, 0.0f) * dt),
        .dt = dt,
        .old_weight = motion.integrator == ParticleIntegrator::ExplicitEuler  ? 1.0f
                      : motion.integrator == ParticleIntegrator::SemiImplicit ? 0.0f
                                                                              : 0.5f,
        .closed_form = closed_form};
    if (motion.drag >= kMinDrag) {
        // Gravity and drag together approach the terminal velocity, exactly for any step.
        found.step.air += found.step.gravity / motion.drag;
        found.step.gravity = Vec3(0);
    }
    // The drift repeats every 4,096 whirls, so that positions in the noise keep their precision.
    const auto turns = static_cast<float>(
        std::fmod(static_cast<double>(motion.turbulence_speed) * time.time, 4096.0));
    found.turbulence = {
        .strength = motion.turbulence,
        .size = std::max(motion.turbulence_size, 1e-3f),
        .drift_a = kDriftA * turns,
        .drift_b = kDriftB * turns};
    found.vortex.around = motion.vortex;
    found.vortex.toward = motion.attraction;
    found.steering.orbit = 1 - std::pow(1 - std::clamp(motion.orbit, 0.0f, 1.0f), kOrbitRate * dt);
    found.steering.loss = std::max(motion.brake, 0.0f) * dt;
    orient_motion(found, world);
    return found;
}

void orient_motion(MotionStep& motion, const Affine& world) {
    motion.vortex.origin = transform_point(world, Vec3(0));
    motion.vortex.axis = normalize_or(transform_vector(world, Vec3(0, 1, 0)), Vec3(0, 1, 0));
    motion.steering.origin = motion.vortex.origin;
    motion.steering.axis = motion.vortex.axis;
}

namespace {

void change_velocities(const MotionStep& motion, const ParticleBlock& block) {
    const float dt = motion.step.dt;
    if (motion.turbulence.strength != 0) {
        apply_turbulence(block, motion.turbulence, dt);
    }
    if (!motion.forces.empty()) {
        apply_forces(block, motion.forces, motion.force_scale, dt);
    }
    if (motion.vortex.around != 0 || motion.vortex.toward != 0) {
        apply_vortex(block, motion.vortex, dt);
    }
    if (motion.steering.orbit > 0 || motion.steering.loss > 0) {
        apply_steering(block, motion.steering);
    }
}

/// Explicit Euler: positions by the velocities at the beginning of the step.
std::size_t move_by_old_velocities(const MotionStep& motion, const ParticleBlock& block) {
    std::array<std::vector<float>, 3> ends;
    float* const positions[] = {block.x, block.y, block.z};
    const float* const speeds[] = {block.vx, block.vy, block.vz};
    for (int axis = 0; axis < 3; ++axis) {
        ends[axis].resize(block.count);
        for (std::size_t i = 0; i < block.count; ++i) {
            ends[axis][i] = positions[axis][i] + speeds[axis][i] * motion.step.dt;
        }
    }
    change_velocities(motion, block);
    const std::size_t dead = move_particles(block, motion.step);
    for (int axis = 0; axis < 3; ++axis) {
        std::copy(ends[axis].begin(), ends[axis].end(), positions[axis]);
    }
    return dead;
}

}  // namespace

std::size_t move_block(const MotionStep& motion, const ParticleBlock& block) {
    std::size_t dead = 0;
    if (motion.step.old_weight == 1) {
        dead = move_by_old_velocities(motion, block);
    } else {
        change_velocities(motion, block);
        dead = move_particles(block, motion.step);
    }
    if (motion.wrap_size != Vec3(0)) {
        wrap_particles(block, motion.wrap_center, motion.wrap_size);
    }
    return dead;
}

}  // namespace limn
