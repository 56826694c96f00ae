#include "systems/animation/clip_player_system.h"

namespace limn {

void advance_clips(
    Query<ClipPlayer, Without<PoseKeysState>> players, Query<MorphPlayer> morph_players,
    Res<const Assets> assets, Res<const FrameTime> time) {
    const auto advance = [&](auto& player) {
        if (player.clip.index < assets->clips.size()) {
            player.time =
                step_clip_time(player, assets->clips[player.clip.index].duration, time->step);
        }
    };
    players.each(advance);
    morph_players.each([&](MorphPlayer& player) {
        for (MorphAnimation& animation : player.animations) {
            advance(animation);
        }
    });
}

}  // namespace limn
