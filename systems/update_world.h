#pragma once

#include "ecs/schedule.h"
#include "ecs/world.h"

namespace limn {

// The simulation: one step of all systems, as a list. Time, input and chance are resources, so that
// the same start and the same input give the same worlds, bit for bit, on any number of threads.

/// All systems, in their order.
[[nodiscard]] Schedule make_world_schedule();

/// Puts everything where it is at time 0: the systems that follow from the time alone, then the
/// matrices. The first picture needs no step, and the first step makes no jump. Inserts
/// missing resources as step_world does.
void start_world(World& world);

/// Advances FrameTime by one step and runs the schedule. Resources that the systems need
/// (FrameTime, RandomSeed, Input, Assets) are inserted with their defaults where they are missing.
void step_world(World& world, Schedule& schedule);

}  // namespace limn
