#include "ecs/schedule.h"

#include "ecs/base/text.h"
#include "ecs/world.h"

#include <algorithm>
#include <chrono>

namespace limn {

namespace {

/// Minimum expected gain for running a stage on several threads [s].
constexpr double kMinParallelGain = 20e-6;
/// Weight of the newest run in the running average.
constexpr double kNewestWeight = 0.25;

using Clock = std::chrono::steady_clock;

double seconds(Clock::duration duration) {
    return std::chrono::duration<double>(duration).count();
}

std::string names_of(const std::vector<ComponentId>& ids) {
    std::string names;
    for (const ComponentId id : ids) {
        names += names.empty() ? "" : ", ";
        names += component_info(id).name;
    }
    return names;
}

/// Seconds as milliseconds, right-aligned.
std::string ms_text(double time) {
    return align_right(fixed_text(time * 1e3, 3), 9);
}

void add_part(std::string& line, std::string_view what, const std::string& names) {
    if (!names.empty()) {
        line += format_text("  {} {}", what, names);
    }
}

std::string access_text(const SystemAccess& access) {
    std::string line;
    add_part(line, "reads", names_of(access.reads));
    add_part(line, "writes", names_of(access.writes));
    add_part(line, "uses", names_of(access.resource_reads));
    add_part(line, "changes", names_of(access.resource_writes));
    line += access.reads_all ? "  reads everything" : "";
    line += access.commands ? "  commands" : "";
    line += access.exclusive ? "  exclusive" : "";
    return line;
}

}  // namespace

Schedule& Schedule::add(System system) {
    timings_.push_back({system.name(), 0, 0, 0});
    expected_.push_back(0);
    systems_.push_back(std::move(system));
    is_built_ = false;
    return *this;
}

Schedule& Schedule::sync() {
    sync_points_.push_back(systems_.size());
    is_built_ = false;
    return *this;
}

void Schedule::reset_timings() {
    for (SystemTiming& timing : timings_) {
        timing = {timing.name, 0, 0, 0};
    }
    for (SyncTiming& timing : sync_timings_) {
        timing = {timing.system};
    }
}

// ---- stages
// ----------------------------------------------------------------------------------------

void Schedule::build() const {
    stages_.clear();
    sync_timings_.clear();
    for (std::size_t i = 0; i < systems_.size(); ++i) {
        const bool exclusive = systems_[i].access().exclusive;
        const bool begins =
            stages_.empty() || exclusive || stages_.back().is_exclusive
            || std::find(sync_points_.begin(), sync_points_.end(), i) != sync_points_.end();
        if (begins) {
            Stage& stage = stages_.emplace_back();
            stage.first = i;
            stage.is_exclusive = exclusive;
        }
        ++stages_.back().count;
    }
    for (Stage& stage : stages_) {
        build_stage(stage);
        for (std::size_t i = stage.first; i < stage.first + stage.count; ++i) {
            if (systems_[i].access().commands) {
                stage.recorders.push_back(i);
            }
        }
        if (!stage.recorders.empty()) {
            stage.sync = sync_timings_.size();
            sync_timings_.push_back({stage.first + stage.count - 1});
        }
    }
    is_built_ = true;
}

void Schedule::build_stage(Stage& stage) const {
    // after[i][j]: i depends on j, possibly transitively. Edges implied by a path are omitted.
    std::vector<std::vector<bool>> after(stage.count, std::vector<bool>(stage.count, false));
    for (std::size_t i = 0; i < stage.count; ++i) {
        std::vector<std::size_t>& waits_for = stage.waits_for.emplace_back();
        for (std::size_t j = i; j-- > 0;) {
            const SystemAccess& earlier = systems_[stage.first + j].access();
            if (after[i][j] || !systems_[stage.first + i].access().conflicts_with(earlier)) {
                continue;
            }
            waits_for.push_back(j);
            after[i][j] = true;
            for (std::size_t k = 0; k < j; ++k) {
                after[i][k] = after[i][k] || after[j][k];
            }
        }
        std::reverse(waits_for.begin(), waits_for.end());
        stage.graph.add(waits_for);
        stage.is_chain = stage.is_chain && (i == 0 || after[i][i - 1]);
    }
}

bool Schedule::is_worth_threads(const Stage& stage) const {
    if (stage.is_chain || always_parallel_) {
        return !stage.is_chain;
    }
    if (thread_count() == 1) {
        return false;
    }
    // The gain is bounded by the critical path: the longest chain of dependent systems.
    std::vector<double> ready(stage.count);
    double total = 0;
    double longest = 0;
    for (std::size_t i = 0; i < stage.count; ++i) {
        for (const std::size_t before : stage.waits_for[i]) {
            ready[i] = std::max(ready[i], ready[before]);
        }
        ready[i] += expected_[stage.first + i];
        total += expected_[stage.first + i];
        longest = std::max(longest, ready[i]);
    }
    return total - longest > kMinParallelGain;
}

// ---- running
// ---------------------------------------------------------------------------------------

void Schedule::run(World& world) {
    if (!is_built_) {
        build();
    }
    for (Stage& stage : stages_) {
        // Buffers belong to systems that may have been moved since the stage was built.
        stage.commands.clear();
        for (const std::size_t system : stage.recorders) {
            stage.commands.push_back(systems_[system].commands());
        }
        run_stage(world, stage);
        apply(world, stage);
    }
}

void Schedule::run_stage(World& world, const Stage& stage) {
    const std::uint32_t version = world.begin_run(static_cast<std::uint32_t>(stage.count));
    for (std::size_t i = 0; i < stage.count; ++i) {
        systems_[stage.first + i].prepare(world);
    }
    if (stage.is_exclusive) {
        run_timed(world, stage.first, version);
    } else if (is_worth_threads(stage)) {
        run_task_graph(stage.graph, [&](std::size_t task) {
            run_timed(world, stage.first + task, version + static_cast<std::uint32_t>(task));
        });
    } else {
        run_sequential(world, stage, version);
    }
}

/// Locks once for the whole stage, and reads the clock once per system: the end of one is the start
/// of the next. Otherwise these would be most of the cost of an idle system.
void Schedule::run_sequential(World& world, const Stage& stage, std::uint32_t version) {
    const IterationGuard guard(world.core(), IterationLock::Shared);
    Clock::time_point start = Clock::now();
    for (std::size_t i = 0; i < stage.count; ++i) {
        systems_[stage.first + i].run_locked(world, version + static_cast<std::uint32_t>(i));
        const Clock::time_point end = Clock::now();
        note_time(stage.first + i, seconds(end - start));
        start = end;
    }
}

void Schedule::run_timed(World& world, std::size_t system, std::uint32_t version) {
    const Clock::time_point start = Clock::now();
    systems_[system].run(world, version);
    note_time(system, seconds(Clock::now() - start));
}

void Schedule::note_time(std::size_t system, double duration) {
    SystemTiming& timing = timings_[system];
    ++timing.runs;
    timing.last = duration;
    timing.mean += (duration - timing.mean) / static_cast<double>(timing.runs);
    expected_[system] += (duration - expected_[system]) * (timing.runs == 1 ? 1.0 : kNewestWeight);
}

void Schedule::apply(World& world, const Stage& stage) {
    std::uint64_t recorded = 0;
    for (std::size_t i = 0; i < stage.commands.size(); ++i) {
        if (const std::size_t count = stage.commands[i]->size(); count > 0) {
            SystemTiming& timing = timings_[stage.recorders[i]];
            timing.commands += count;
            timing.last_commands = count;
            recorded += count;
        }
    }
    if (recorded == 0) {
        return;
    }
    const Clock::time_point start = Clock::now();
    apply_commands(world, stage.commands);
    SyncTiming& sync = sync_timings_[stage.sync];
    ++sync.runs;
    sync.commands += recorded;
    sync.last = seconds(Clock::now() - start);
    sync.mean += (sync.last - sync.mean) / static_cast<double>(sync.runs);
}

// ---- printing
// --------------------------------------------------------------------------------------

std::string Schedule::to_text() const {
    if (!is_built_) {
        build();
    }
    std::size_t width = 0;
    for (const System& system : systems_) {
        width = std::max(width, system.name().size());
    }
    std::string text;
    for (std::size_t number = 0; number < stages_.size(); ++number) {
        const Stage& stage = stages_[number];
        text += format_text("stage {}\n", number + 1);
        for (std::size_t i = 0; i < stage.count; ++i) {
            const System& system = systems_[stage.first + i];
            const SystemTiming& timing = timings_[stage.first + i];
            text += "  " + align_left(system.name(), width);
            if (timing.runs > 0) {
                text +=
                    format_text("  {} ms  mean {} ms", ms_text(timing.last), ms_text(timing.mean));
            }
            text += access_text(system.access());
            std::string before;
            for (const std::size_t task : stage.waits_for[i]) {
                before += before.empty() ? "" : ", ";
                before += systems_[stage.first + task].name();
            }
            add_part(text, "after", before);
            text += '\n';
        }
        if (!stage.recorders.empty() && sync_timings_[stage.sync].runs > 0) {
            const SyncTiming& sync = sync_timings_[stage.sync];
            text += "  " + align_left("sync", width)
                    + format_text(
                        "  {} ms  mean {} ms  {} commands\n", ms_text(sync.last),
                        ms_text(sync.mean), sync.commands);
        }
    }
    return text;
}

std::string Schedule::to_dot() const {
    if (!is_built_) {
        build();
    }
    std::string dot = "digraph schedule {\n  rankdir=LR;\n  node [shape=box];\n";
    for (std::size_t number = 0; number < stages_.size(); ++number) {
        const Stage& stage = stages_[number];
        dot += format_text(
            "  subgraph cluster_{} {\n    label=\"stage {}\";\n", number + 1, number + 1);
        for (std::size_t i = stage.first; i < stage.first + stage.count; ++i) {
            dot += format_text("    s{} [label=\"{}\"];\n", i, systems_[i].name());
        }
        dot += "  }\n";
        for (std::size_t i = 0; i < stage.count; ++i) {
            for (const std::size_t before : stage.waits_for[i]) {
                dot += format_text("  s{} -> s{};\n", stage.first + before, stage.first + i);
            }
        }
        if (number > 0) {
            dot += format_text(
                "  s{} -> s{} [style=dashed, label=\"sync\"];\n",
                stages_[number - 1].first + stages_[number - 1].count - 1, stage.first);
        }
    }
    return dot + "}\n";
}

}  // namespace limn
