#include "bench/characters/character_race.h"
#include "bench/characters/character_rows.h"
#include "bench/characters/scalar_crowd.h"
#include "bench/oracles/crowd_scenes.h"
#include "ecs/base/jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace limn::bench {

void add_avoid_rows(CharacterBench& bench);

namespace {

struct AvoidTimes {
    double ours = 0;       ///< of a walker [ns]
    double reference = 0;  ///< likewise
};

/// Best times of a step among random goals, and of the sums over the same positions. Each run is
/// one of some seconds of walking, in turns: the processor would learn the branches of a single
/// one, which real crowds do not allow (the sums of 1000 would take a fourth).
AvoidTimes time_avoidance(const CharacterBench& bench, std::size_t count, float density) {
    constexpr std::size_t kStates = 24;
    oracle::CrowdScene scene = oracle::make_random_crowd(count, density);
    std::vector<std::vector<CrowdWalker>> states;
    std::vector<std::vector<float>> x;
    std::vector<std::vector<float>> y;
    while (states.size() < kStates) {
        for (int i = 0; i < 30; ++i) {
            scene.step();
        }
        states.push_back(scene.walkers);
        x.emplace_back();
        y.emplace_back();
        for (const CrowdWalker& walker : scene.walkers) {
            x.back().push_back(walker.position.x);
            y.back().push_back(walker.position.y);
        }
    }
    NeighborSums memory;
    std::vector<CrowdWalker> walkers;
    std::size_t copied = 0;
    std::size_t stepped = 0;
    std::size_t summed = 0;
    const auto [copy, ours, by_hand] = race(
        thread_seconds, bench.repeats,
        [&] {
            walkers = states[copied++ % kStates];
            keep(walkers.data());
        },
        [&] {
            walkers = states[stepped++ % kStates];
            step_crowd(walkers, {}, oracle::CrowdScene::kStep, scene.scratch);
        },
        [&] {
            const std::size_t state = summed++ % kStates;
            sum_neighbors_by_hand(x[state].data(), y[state].data(), count, scene.side, memory);
            keep(memory.sums.data());
        });
    const double ns = 1e9 / static_cast<double>(count);
    return {(ours - copy) * ns, by_hand * ns};
}

void add_time_rows(CharacterBench& bench) {
    const AvoidTimes few = time_avoidance(bench, 1000, 0.25f);
    const AvoidTimes more = time_avoidance(bench, 2000, 0.25f);
    const AvoidTimes many = time_avoidance(bench, 10000, 0.25f);
    const AvoidTimes dense = time_avoidance(bench, 2000, 1);
    const auto add = [&](const char* gate, const char* name, const AvoidTimes& times,
                         double limit) {
        bench.add(
            {.gate = gate,
             .name = name,
             .ours = times.ours,
             .reference = times.reference,
             .against = "sums over 3x3 cells",
             .limit = limit,
             .stretch = limit > 0 ? 5.0 : 0.0,
             .peer = "16 - 23 (RVO2)"});
    };
    add("14", "avoidance of 1000 walkers, 0.25/m2, per walker", few, 8);
    add("14", "avoidance of 2000 walkers, 0.25/m2, per walker", more, 8);
    add("14", "avoidance of 10000 walkers, 0.25/m2, per walker", many, 8);
    add("", "avoidance of 2000 walkers, 1/m2, per walker", dense, 0);
    bench.add(
        {.gate = "15",
         .name = "the same: 10000 over 1000",
         .ours = many.ours,
         .reference = few.ours,
         .against = "1000 walkers",
         .limit = 1.15,
         .stretch = 1.0,
         .peer = "1.23 (RVO2)"});
}

/// Pairs that overlap by more than 1 mm, the most at any time of `seconds`.
double most_overlaps(oracle::CrowdScene scene, float seconds) {
    std::size_t most = 0;
    for (int i = 0; i < static_cast<int>(60 * seconds); ++i) {
        scene.step();
        if (i % 30 == 0) {
            most = std::max(most, scene.overlaps().first);
        }
    }
    return static_cast<double>(most);
}

void add_overlap_row(CharacterBench& bench, const char* name, double most, const char* peer) {
    bench.add(
        {.gate = "16",
         .name = name,
         .ours = most,
         .unit = "pairs",
         .limit = 0.5,
         .stretch = 0.5,
         .peer = peer});
}

}  // namespace

void add_avoid_rows(CharacterBench& bench) {
    const int before = thread_count();
    set_thread_count(1);
    add_time_rows(bench);
    add_overlap_row(
        bench, "overlaps > 1 mm of 1000, 1/m2, 10 s",
        most_overlaps(oracle::make_random_crowd(1000, 1), 10), "10.9 (RVO2)");
    add_overlap_row(
        bench, "overlaps > 1 mm of 1000 in rings, 30 s",
        most_overlaps(oracle::make_crowd_rings(1000, 12.9f, 1), 30), "72 (RVO2)");
    const auto add_ring = [&](const char* gate, std::size_t count, double limit, double stretch,
                              const char* peer) {
        bench.add(
            {.gate = gate,
             .name = fmt::format("ring of {}: last arrival over straight time", count),
             .ours = oracle::ring_ratio(count, 1),
             .unit = "",
             .limit = limit,
             .stretch = stretch,
             .peer = peer});
    };
    add_ring("17", 100, 1.6, 1.3, "2.0 (RVO2)");
    add_ring("18", 250, 2.0, 1.5, "none");
    set_thread_count(before);
}

}  // namespace limn::bench
