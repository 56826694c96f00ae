#pragma once

#include "ecs/schedule.h"
#include "ecs/world.h"

#include <cstdint>
#include <vector>

namespace limn {

// The simulation as one list of systems. Each belongs to a phase of the step and says whether it
// runs in each step, at the start, or both. A domain adds its systems in a function of its own,
// which is also how layers above this one contribute theirs (content/game).
//
// Time, input and random seed are resources, so that equal initial states and inputs give
// bit-identical worlds on any number of threads.

/// Phases of a step, in their order. Within one, systems keep the order in which they were added.
enum class Phase : std::uint8_t {
    Events,   ///< timed events: all other systems see their changes
    Create,   ///< adds state components to new entities; then a sync point
    Move,     ///< what moves by time, path or input; weather
    Waves,    ///< water surfaces at the end of the step
    Animate,  ///< characters and what is attached to them
    Force,    ///< what acts on floating bodies, with the water of this step; then a sync point
    Float,    ///< bodies in water, walkers
    Place,    ///< world transforms, after everything that moves entities
    Follow,   ///< what needs current world transforms
    View,     ///< cameras that follow, lenses
};

enum class When : std::uint8_t { EachStep, AtStart, Both };

class SystemList {
  public:
    template <auto function>
    void add(Phase phase, When when = When::EachStep) {
        entries_.push_back({phase, when, [] { return make_system<function>(); }});
    }
    /// Those of each step.
    [[nodiscard]] Schedule make_schedule() const;
    /// Runs those at the start; their commands are applied one system at a time.
    void run_start(World& world) const;

  private:
    struct Entry {
        Phase phase;
        When when;
        System (*make)();
    };
    [[nodiscard]] std::vector<Entry> in_order(When when) const;

    std::vector<Entry> entries_;
};

using AddSystems = void (*)(SystemList&);

void add_object_systems(SystemList& systems);
void add_animation_systems(SystemList& systems);
void add_crowd_systems(SystemList& systems);
void add_character_systems(SystemList& systems);
void add_water_systems(SystemList& systems);
void add_particle_systems(SystemList& systems);
void add_camera_systems(SystemList& systems);

/// All systems of the engine, then those of `more`.
[[nodiscard]] Schedule make_world_schedule(AddSystems more = nullptr);

/// Computes the state at time 0: systems that depend on time only, then the matrices. So the first
/// frame needs no step, and the first step has no jump. Inserts missing resources like step_world.
void start_world(World& world, AddSystems more = nullptr);

/// Advances FrameTime by one step and runs the schedule. Resources that the systems need
/// (FrameTime, RandomSeed, Input, Assets ...) are inserted with their defaults if missing.
void step_world(World& world, Schedule& schedule);

}  // namespace limn
