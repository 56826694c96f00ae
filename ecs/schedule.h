#pragma once

#include "ecs/base/jobs.h"
#include "ecs/system.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace limn {

// The frame, as a list of systems:
//
//     Schedule schedule;
//     schedule.add<update_wind>();
//     schedule.add<update_water>();       // after wind: gusts raise ripples
//     schedule.add<update_transforms>();  // last: rendering reads the matrices
//     schedule.run(world);
//
// The list is the order: a system sees what all systems before it wrote and nothing of those behind
// it. Systems that touch different things (their parameters say what) run at the same time all the
// same, which nobody can tell from the result: it has the same bits for any number of threads.
// Commands are applied, in the order of the list, at sync points: before and after every exclusive
// system (World&), where sync() says so, and at the end.
//
// Between sync points lies a stage. Its systems are handed to other threads only if that has saved
// time before: a hundred small systems are quicker in a row than handed around.

/// How long a system took, without the commands it recorded.
struct SystemTiming {
    std::string name;
    double last = 0.0;  ///< of the last run [s]
    double mean = 0.0;  ///< over all runs since the schedule was made or reset_timings() [s]
    std::uint64_t runs = 0;
    std::uint64_t commands = 0;       ///< recorded in all runs
    std::uint64_t last_commands = 0;  ///< recorded in the last run that recorded any
};

/// How long applying the commands of a stage took. Runs without commands do not count.
struct SyncTiming {
    std::size_t system = 0;  ///< the last of the stage
    double last = 0.0;       ///< [s]
    double mean = 0.0;       ///< [s]
    std::uint64_t runs = 0;
    std::uint64_t commands = 0;
};

class Schedule {
  public:
    /// Appends a system, named like the function.
    template <auto function>
    Schedule& add() {
        return add(make_system<function>());
    }
    /// Appends a function object.
    template <typename F>
    Schedule& add(std::string name, F function) {
        return add(make_system(std::move(name), std::move(function)));
    }
    Schedule& add(System system);
    /// Systems from here on see what the commands before did.
    Schedule& sync();

    /// Runs all systems once.
    void run(World& world);

    [[nodiscard]] std::size_t size() const { return systems_.size(); }
    /// In the order of the list.
    [[nodiscard]] std::span<const SystemTiming> timings() const { return timings_; }
    /// Of every stage with systems that take Commands, in order. Empty before the first run.
    [[nodiscard]] std::span<const SyncTiming> sync_timings() const { return sync_timings_; }
    [[nodiscard]] std::span<const System> systems() const { return systems_; }
    void reset_timings();
    /// Whether stages with something to gain are run by several threads even if measurements speak
    /// against it: for tests. At start, no.
    void set_always_parallel(bool always) { always_parallel_ = always; }

    /// A line a system: stage, name, what it reads and writes, which systems it waits for, how long
    /// it took.
    [[nodiscard]] std::string to_text() const;
    /// The same for Graphviz: boxes are stages, arrows mean "waits for".
    [[nodiscard]] std::string to_dot() const;

  private:
    /// Systems first .. first + count - 1, between two sync points.
    struct Stage {
        std::size_t first = 0;
        std::size_t count = 0;
        bool is_exclusive = false;
        bool is_chain = true;  ///< no two systems can run at the same time
        TaskGraph graph;
        std::vector<std::vector<std::size_t>>
            waits_for;  ///< systems of the stage, from 0; without what follows
        std::vector<CommandBuffer*> commands;
        std::vector<std::size_t> recorders;  ///< the systems whose commands they are
        std::size_t sync = 0;                ///< in sync_timings_
    };

    void build() const;
    void build_stage(Stage& stage) const;
    [[nodiscard]] bool is_worth_threads(const Stage& stage) const;
    void run_stage(World& world, const Stage& stage);
    void run_in_row(World& world, const Stage& stage, std::uint32_t version);
    void run_timed(World& world, std::size_t system, std::uint32_t version);
    void note_time(std::size_t system, double duration);
    void apply(World& world, const Stage& stage);

    std::vector<System> systems_;
    std::vector<SystemTiming> timings_;
    mutable std::vector<SyncTiming> sync_timings_;
    std::vector<double> expected_;          ///< running average of each system [s]
    std::vector<std::size_t> sync_points_;  ///< before the system of this number
    mutable std::vector<Stage> stages_;
    mutable bool is_built_ = false;
    bool always_parallel_ = false;
};

}  // namespace limn
