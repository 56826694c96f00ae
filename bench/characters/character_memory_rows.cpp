#include "bench/characters/character_crowd.h"
#include "bench/characters/character_rows.h"

namespace limn::bench {

void add_memory_rows(CharacterBench& bench);

void add_memory_rows(CharacterBench& bench) {
    constexpr std::size_t kJoints = 67;
    const BenchCrowd crowd(kJoints, 1);
    double packed = 0;
    double floats = 0;
    double error = 0;
    for (std::size_t i = 0; i < crowd.clips.size(); ++i) {
        packed += static_cast<double>(crowd_clip_bytes(crowd.clips[i]));
        floats += static_cast<double>(crowd.scalar_clips[i].frames * kJoints * 10 * sizeof(float));
        error = std::max(error, static_cast<double>(crowd.clips[i].error));
    }
    bench.add(
        {.gate = "21",
         .name = "size of clips: 10 floats over crowd clips",
         .ours = floats / packed,
         .unit = ":1",
         .limit = 6,
         .stretch = 8,
         .peer = "6.0 (ozz)",
         .at_least = true});
    bench.add(
        {.gate = "21",
         .name = "their error at a shell of 10 cm",
         .ours = error * 1e3,
         .unit = "mm",
         .limit = 1});
}

}  // namespace limn::bench
