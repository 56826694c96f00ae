#include "systems/animation/pose_keys_system.h"

#include "ecs/base/log.h"
#include "systems/animation/clip_sampling.h"

// Techniques: anim.pose-keys, char.fk-keypose

namespace limn {
namespace {

PoseKeysState
make_pose_state(const PoseKeys& keys, const Skeleton& skeleton, const Assets& assets) {
    PoseKeysState state;
    state.skeleton = skeleton.skeleton;
    if (skeleton.skeleton.index >= assets.skeletons.size()) {
        return state;
    }
    const SkeletonData& data = assets.skeletons[skeleton.skeleton.index];
    Result<ClipData> clip = make_pose_clip(data, keys);
    if (clip) {
        state.clip = *std::move(clip);
    } else {
        log_error("pose_keys of skeleton {}: {}", data.name, clip.error().message);
    }
    return state;
}

}  // namespace

void add_pose_keys_states(
    Query<const PoseKeys, const Skeleton, Without<PoseKeysState>> keyed, Res<const Assets> assets,
    Commands commands) {
    keyed.each([&](Entity entity, const PoseKeys& keys, const Skeleton& skeleton) {
        commands.add(entity, make_pose_state(keys, skeleton, *assets));
    });
}

void release_pose_keys(Query<const PoseKeysState, Without<PoseKeys>> released, Commands commands) {
    released.each(
        [&](Entity entity, const PoseKeysState&) { commands.remove<PoseKeysState>(entity); });
}

void prepare_pose_keys(
    Query<const PoseKeys, const Skeleton, PoseKeysState, Changed<PoseKeys>> keyed,
    Res<const Assets> assets) {
    keyed.each([&](const PoseKeys& keys, const Skeleton& skeleton, PoseKeysState& state) {
        state = make_pose_state(keys, skeleton, *assets);
    });
}

void advance_pose_keys(Query<const PoseKeysState, ClipPlayer> players, Res<const FrameTime> time) {
    players.each([&](const PoseKeysState& state, ClipPlayer& player) {
        if (player.speed != 0.0f) {
            player.time = step_clip_time(player, state.clip.duration, time->step);
        }
    });
}

}  // namespace limn
