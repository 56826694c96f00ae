#include "bench/characters/character_crowd.h"
#include "bench/characters/character_race.h"
#include "bench/characters/character_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <vector>

namespace limn::bench {

void add_chain_rows(CharacterBench& bench);

namespace {

struct ChainTimes {
    double ours = 0;    ///< [ns per joint]
    double scalar = 0;  ///< likewise
    double copy = 0;    ///< of the matrices
};

/// Two samples, blended, to matrices ready to skin.
ChainTimes measure_chain(CharacterBench& bench, std::size_t joints, std::size_t count) {
    BenchCrowd crowd(joints, count);
    const std::vector<CrowdCharacter> characters = crowd.characters();
    std::vector<Affine> copied(crowd.matrices.size());
    std::vector<float> buffer;
    const std::size_t passes = std::max<std::size_t>(1, 100'000 / (count * joints));
    const auto repeated = [passes](auto run) {
        return [passes, run] {
            for (std::size_t i = 0; i < passes; ++i) {
                run();
            }
        };
    };
    const auto [ours, scalar, copy] = race(
        thread_seconds, bench.repeats,
        repeated([&] { pose_crowd(crowd.rig, characters, crowd.bind); }),
        repeated([&] { pose_by_hand(crowd, buffer); }), repeated([&] {
            std::memcpy(copied.data(), crowd.matrices.data(), copied.size() * sizeof(Affine));
            keep(copied.data());
        }));
    const double to_ns = 1e9 / static_cast<double>(passes * count * joints);
    return {ours * to_ns, scalar * to_ns, copy * to_ns};
}

/// Next to a copy of its matrices, both from memory: in a frame they are not in the cache.
void add_copy_row(CharacterBench& bench) {
    BenchCrowd crowd(67, 2000);
    const std::vector<CrowdCharacter> characters = crowd.characters();
    std::vector<Affine> copied(crowd.matrices.size());
    const auto [ours, copy] = race_from_memory(
        thread_seconds, std::min(bench.repeats, 30),
        [&] { pose_crowd(crowd.rig, characters, crowd.bind); },
        [&] {
            std::memcpy(copied.data(), crowd.matrices.data(), copied.size() * sizeof(Affine));
            keep(copied.data());
        });
    const double to_ns = 1e9 / static_cast<double>(crowd.matrices.size());
    bench.add(
        {.gate = "7",
         .name = "the same, 2000 of 67 joints, from memory",
         .ours = ours * to_ns,
         .reference = copy * to_ns,
         .against = "memcpy of its matrices",
         .limit = 2.5,
         .stretch = 1.5,
         .peer = "12 (ozz)",
         .vectors = true});
}

}  // namespace

void add_chain_rows(CharacterBench& bench) {
    const char* const peers[] = {"1.7 (ozz)", "1.4 (ozz)", "1.2 (ozz)"};
    double copy = 0;
    double ours = 0;
    for (std::size_t i = 0; const std::size_t joints : {24, 67, 163}) {
        const ChainTimes times = measure_chain(bench, joints, 2000);
        bench.add(
            {.gate = "6",
             .name = fmt::format("2 samples, blend, model, skin: 2000 of {} joints", joints),
             .ours = times.ours,
             .reference = times.scalar,
             .against = "scalar, floats",
             .limit = 0.25,
             .stretch = 0.16,
             .peer = peers[i++],
             .vectors = true});
        if (joints == 67) {
            copy = times.copy;
            ours = times.ours;
        }
    }
    add_copy_row(bench);
    bench.add(
        {.gate = "7",
         .name = "the same, 2000 of 67 joints, in the cache",
         .ours = ours,
         .reference = copy,
         .against = "memcpy of its matrices",
         .limit = 2.5,
         .stretch = 1.5,
         .vectors = true});
    const ChainTimes few = measure_chain(bench, 67, 100);
    const ChainTimes many = measure_chain(bench, 67, 10000);
    bench.add(
        {.gate = "8",
         .name = "the same, 10,000 over 100",
         .ours = many.ours,
         .reference = few.ours,
         .against = "100",
         .limit = 1.3,
         .stretch = 1.1,
         .peer = "2.1 (ozz, 2,000)",
         .vectors = true});
    bench.add(
        {.gate = "",
         .name = "the same, 1 character",
         .ours = measure_chain(bench, 67, 1).ours,
         .reference = few.scalar,
         .against = "scalar, floats"});
    bench.add(
        {.gate = "",
         .name = "the same, 10,000",
         .ours = many.ours,
         .reference = many.copy,
         .against = "memcpy of its matrices"});
}

}  // namespace limn::bench
