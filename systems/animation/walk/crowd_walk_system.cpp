#include "systems/animation/walk/crowd_walk_system.h"

#include "systems/animation/walk/walk_clip.h"

#include <cmath>

// Techniques: char.crowd-script

namespace limn {
namespace {

CrowdWalkClips::Entry
make_crowd_walk(const SkeletonId& skeleton, Entity style, const Walk& walk, Assets& assets) {
    const SkeletonData& data = assets.skeletons[skeleton.index];
    CrowdWalkClips::Entry entry = {
        skeleton,
        style,
        {static_cast<std::uint32_t>(assets.clips.size())},
        walk_clip_speed(data, walk)};
    assets.clips.push_back(make_walk_clip(data, walk));
    return entry;
}

}  // namespace

void add_crowd_walks(
    Query<const CrowdWalk, const Skeleton, Without<ClipPlayer>> members, Query<const Walk> styles,
    Res<Assets> assets, Res<CrowdWalkClips> walks, Commands commands) {
    members.each([&](Entity entity, const CrowdWalk& member, const Skeleton& skeleton) {
        if (skeleton.skeleton.index >= assets->skeletons.size()) {
            return;
        }
        const CrowdWalkClips::Entry* found = walks->find(skeleton.skeleton, member.style);
        if (found == nullptr) {
            const Walk* const walk = styles.find<const Walk>(member.style);
            walks->entries.push_back(make_crowd_walk(
                skeleton.skeleton, member.style, walk != nullptr ? *walk : Walk{}, *assets));
            found = &walks->entries.back();
        }
        const float phase = finite_or(member.phase, 0.0f);
        const float speed = finite_or(member.speed, 0.0f);
        ClipPlayer player;
        player.clip = found->clip;
        player.time = (phase - std::floor(phase)) * assets->clips[found->clip.index].duration;
        player.speed = speed > 0 ? speed / found->speed : 1.0f;
        commands.add(entity, player);
    });
}

}  // namespace limn
