#include "bench/characters/character_crowd.h"
#include "bench/characters/character_rows.h"
#include "content/make/models/creature.h"
#include "ecs/components/animation.h"
#include "ecs/components/crowd_pose.h"
#include "ecs/entity.h"

#include <algorithm>

namespace limn::bench {

void add_memory_rows(CharacterBench& bench);

namespace {

/// Clips as ten floats per joint and key, and as those of crowds.
struct ClipSizes {
    double floats = 0;
    double packed = 0;
    double error = 0;  ///< the largest [m], of a person of 2 m

    void add(const SkeletonData& skeleton, const ClipData& clip) {
        const CrowdClipLimits limits = scale_limits(skeleton);
        const Result<CrowdClip> crowd = make_crowd_clip(skeleton, clip, limits);
        if (!crowd) {
            return;
        }
        std::size_t keys = 0;
        for (const ClipSheet& sheet : clip.sheets) {
            keys = std::max(keys, sheet.times.size());
        }
        floats += static_cast<double>(keys * skeleton.joints.size() * 10 * sizeof(float));
        packed += static_cast<double>(crowd_clip_bytes(*crowd));
        error = std::max(
            error,
            static_cast<double>(crowd->error / limits.tolerance * CrowdClipLimits{}.tolerance));
    }
};

void add_size_rows(
    CharacterBench& bench, const char* gate, const char* name, const ClipSizes& sizes) {
    const bool has_gate = *gate != 0;
    bench.add(
        {.gate = gate,
         .name = std::string("size of clips, 10 floats over ours: ") + name,
         .ours = sizes.floats / sizes.packed,
         .unit = ":1",
         .limit = has_gate ? 6.0 : 0.0,
         .stretch = has_gate ? 8.0 : 0.0,
         .peer = has_gate ? "6.0 (ozz)" : "",
         .at_least = true});
    bench.add(
        {.gate = gate,
         .name = std::string("their error at a shell of 10 cm: ") + name,
         .ours = sizes.error * 1e3,
         .unit = "mm",
         .limit = has_gate ? 1.0 : 0.0});
}

}  // namespace

void add_memory_rows(CharacterBench& bench) {
    constexpr std::size_t kCharacter = sizeof(Entity) + sizeof(Skeleton) + sizeof(ClipPlayer)
                                       + sizeof(CrowdPose) + sizeof(CrowdPoseState) + sizeof(Pose);
    bench.add(
        {.gate = "20",
         .name = "a character that plays a clip, without matrices",
         .ours = kCharacter,
         .unit = "B",
         .limit = 512,
         .stretch = 256,
         .peer = "15700 (ozz)"});
    constexpr std::size_t kJoints = 67;
    ClipSizes made;
    const SkeletonData skeleton = make_bench_skeleton(kJoints);
    for (std::uint64_t i = 0; i < kBenchClips; ++i) {
        made.add(skeleton, make_bench_clip(skeleton, i));
    }
    add_size_rows(bench, "21", "67 joints", made);
    ClipSizes fox;
    const MeshRig rig = make_creature_rig({});
    for (const ClipData& clip : rig.clips) {
        fox.add(rig.skeleton, clip);
    }
    add_size_rows(bench, "", "the fox, 24 joints", fox);
}

}  // namespace limn::bench
