#include "systems/animation/clip_player_system.h"

#include "systems/animation/clip_sampling.h"

namespace limn {

float step_clip_time(const ClipPlayer& player, float duration, float step) {
    return clip_time(duration, player.time + player.speed * step, player.loop);
}

void advance_clips(Query<ClipPlayer> players, Res<const Assets> assets, Res<const FrameTime> time) {
    players.each([&](ClipPlayer& player) {
        if (player.clip.index < assets->clips.size()) {
            player.time =
                step_clip_time(player, assets->clips[player.clip.index].duration, time->step);
        }
    });
}

}  // namespace limn
