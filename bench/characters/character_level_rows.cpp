#include "bench/characters/character_race.h"
#include "bench/characters/character_rows.h"
#include "content/make/person/person.h"
#include "ecs/base/check.h"
#include "ecs/base/rng.h"
#include "systems/animation/pose_chain.h"
#include "systems/animation/walk/activity_clip.h"
#include "systems/animation/walk/walk_clip.h"

#include <fmt/format.h>

#include <cstddef>
#include <vector>

// Levels of detail of the skeleton of the people of `plaza`: clips to matrices, by the joints that
// the meshes of a level need.

namespace limn::bench {

void add_level_rows(CharacterBench& bench);

namespace {

constexpr std::size_t kPeople = 2000;
constexpr std::size_t kLevels[] = {22, 20};

/// People who walk, or stop and fade into talking.
struct Walkers {
    SkeletonData skeleton = make_person_rig({.seed = 101}).skeleton;
    std::vector<CrowdClip> clips;
    std::vector<CrowdCharacter> characters;
    std::vector<Affine> matrices;

    Walkers() : matrices(kPeople * skeleton.joints.size()) {
        for (const ClipData& clip :
             {make_walk_clip(skeleton, {.speed = 1.3f}),
              make_activity_clip(skeleton, CrowdActivity::Talk)}) {
            Result<CrowdClip> packed = make_crowd_clip(skeleton, clip, scale_limits(skeleton));
            LIMN_CHECK(packed);
            clips.push_back(*std::move(packed));
        }
        Random random(1, 0, name_hash("bench levels"), 0);
        for (std::size_t i = 0; i < kPeople; ++i) {
            const bool fades = i % 8 == 0;
            characters.push_back(
                {.clip = &clips[0],
                 .time = random.uniform(0.0f, clips[0].duration),
                 .next = fades ? &clips[1] : nullptr,
                 .next_time = random.uniform(0.0f, clips[1].duration),
                 .weight = random.uniform(),
                 .joints = &matrices[i * skeleton.joints.size()]});
        }
    }
};

}  // namespace

void add_level_rows(CharacterBench& bench) {
    const Walkers walkers;
    const CrowdRig whole = make_crowd_rig(walkers.skeleton);
    for (const std::size_t joints : kLevels) {
        const CrowdRig rig = make_crowd_rig(walkers.skeleton, joints);
        const auto [ours, all] = race(
            thread_seconds, bench.repeats, [&] { pose_crowd(rig, walkers.characters); },
            [&] { pose_crowd(whole, walkers.characters); });
        constexpr double kNs = 1e9 / kPeople;
        const std::string against = fmt::format("all {} joints", whole.joints());
        bench.add(
            {.gate = "",
             .name = fmt::format("a pose of the first {} joints, per person", joints),
             .ours = ours * kNs,
             .reference = all * kNs,
             .against = against});
        bench.add(
            {.gate = "",
             .name = fmt::format("palette of {} joints, per person", joints),
             .ours = static_cast<double>(rig.joints() * sizeof(Affine)),
             .reference = static_cast<double>(whole.joints() * sizeof(Affine)),
             .against = against,
             .unit = "B"});
    }
}

}  // namespace limn::bench
