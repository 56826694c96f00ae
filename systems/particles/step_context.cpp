#include "systems/particles/step_context.h"

#include "systems/particles/force_fields.h"
#include "systems/particles/particle_motion.h"

#include <algorithm>

namespace limn {

StepContext find_step_context(const ParticleEnvironment& environment) {
    StepContext context;
    context.dt = std::min(environment.time->step, kMaxParticleStep);
    context.time = *environment.time;
    context.seed = environment.seed->seed;
    if (environment.weather) {
        context.wind = current_weather(*environment.weather, *environment.gusts).wind();
    }
    context.forces = find_forces(environment.fields, environment.time->time);
    context.eye = find_viewpoint(environment.cameras);
    return context;
}

MotionStep find_emitter_motion(
    const ParticleMotion* motion, const ParticleWrap* wrap, const Affine& world,
    const StepContext& context) {
    static const ParticleMotion kDefaultMotion;
    MotionStep step = find_motion(
        motion != nullptr ? *motion : kDefaultMotion, world, context.wind, context.forces,
        context.dt, context.time);
    set_wrap(step, wrap, context);
    return step;
}

void set_wrap(MotionStep& motion, const ParticleWrap* wrap, const StepContext& context) {
    const bool wraps = wrap != nullptr && !motion.step.closed_form;
    motion.wrap_size = wraps ? wrap->size : Vec3(0);
    motion.wrap_center = wraps ? context.eye.position : Vec3(0);
}

}  // namespace limn
