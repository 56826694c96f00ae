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
// The list defines the order: a system sees everything that earlier systems wrote and nothing from
// later ones. Systems with disjoint accesses (declared by their parameters) still run in parallel;
// the result is bit-identical for any number of threads. Commands are applied, in list order, at
// sync points: before and after every exclusive system (World&), at sync(), and at the end.
//
// The systems between two sync points form a stage. A stage runs on several threads only if its
// measured times predict a gain: a hundred small systems are faster sequentially.

/// Run time of a system, excluding the commands it recorded.
struct SystemTiming {
    std::string name;
    double last = 0.0;  ///< of the last run [s]
    double mean = 0.0;  ///< over all runs since creation or reset_timings() [s]
    std::uint64_t runs = 0;
    std::uint64_t commands = 0;       ///< recorded in all runs
    std::uint64_t last_commands = 0;  ///< recorded in the last run that recorded any
};

/// Time to apply the commands of a stage. Runs without commands do not count.
struct SyncTiming {
    std::size_t system = 0;  ///< index of the stage's last system
    double last = 0.0;       ///< [s]
    double mean = 0.0;       ///< [s]
    std::uint64_t runs = 0;
    std::uint64_t commands = 0;
};

class Schedule {
  public:
    /// Appends a system named after the function.
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
    /// Adds a sync point: later systems see the effects of earlier commands.
    Schedule& sync();

    /// Runs all systems once.
    void run(World& world);

    [[nodiscard]] std::size_t size() const { return systems_.size(); }
    /// In list order.
    [[nodiscard]] std::span<const SystemTiming> timings() const { return timings_; }
    /// For every stage with systems that take Commands, in order. Empty before the first run.
    [[nodiscard]] std::span<const SyncTiming> sync_timings() const { return sync_timings_; }
    [[nodiscard]] std::span<const System> systems() const { return systems_; }
    void reset_timings();
    /// For tests: runs every stage that can be parallel on several threads, whatever the
    /// measurements. Off by default.
    void set_always_parallel(bool always) { always_parallel_ = always; }

    /// One line per system: stage, name, reads and writes, dependencies, run time.
    [[nodiscard]] std::string to_text() const;
    /// The dependency graph for Graphviz: boxes are stages, arrows are dependencies.
    [[nodiscard]] std::string to_dot() const;

  private:
    /// Systems first .. first + count - 1, between two sync points.
    struct Stage {
        std::size_t first = 0;
        std::size_t count = 0;
        bool is_exclusive = false;
        bool is_chain = true;  ///< no two systems can run in parallel
        TaskGraph graph;
        /// Direct dependencies of each system, as indices in the stage; transitive ones omitted.
        std::vector<std::vector<std::size_t>> waits_for;
        std::vector<CommandBuffer*> commands;
        std::vector<std::size_t> recorders;  ///< systems that take Commands
        std::size_t sync = 0;                ///< index in sync_timings_
    };

    void build() const;
    void build_stage(Stage& stage) const;
    [[nodiscard]] bool is_worth_threads(const Stage& stage) const;
    void run_stage(World& world, const Stage& stage);
    void run_sequential(World& world, const Stage& stage, std::uint32_t version);
    void run_timed(World& world, std::size_t system, std::uint32_t version);
    void note_time(std::size_t system, double duration);
    void apply(World& world, const Stage& stage);

    std::vector<System> systems_;
    std::vector<SystemTiming> timings_;
    mutable std::vector<SyncTiming> sync_timings_;
    std::vector<double> expected_;          ///< running average of each system's time [s]
    std::vector<std::size_t> sync_points_;  ///< each before the system with this index
    mutable std::vector<Stage> stages_;
    mutable bool is_built_ = false;
    bool always_parallel_ = false;
};

}  // namespace limn
