#include "systems/animation/walk/crowd_script_system.h"

#include "ecs/base/hash.h"
#include "ecs/base/rng.h"
#include "systems/animation/walk/activity_clip.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.crowd-script

namespace limn {
namespace {

constexpr float kStartSpeed = 0.35f;    // at which someone who stands walks [m/s]
constexpr float kStopSpeed = 0.15f;     // at which someone who walks stands [m/s]
constexpr float kWaveTime = 2.4f;       // twice the clip [s]
constexpr float kAttentionTime = 0.6f;  // until all attention is there [s]
constexpr float kForget = 1.4f;         // times the distance of noticing
constexpr float kSideways = -0.1f;      // cosine of the widest angle to the front at which it looks
constexpr float kEyeHeight = 1.6f;      // of whom it notices [m]

/// The clip of an activity; made when it is needed for the first time.
ClipId
find_activity(SkeletonId skeleton, CrowdActivity activity, CrowdWalkClips& walks, Assets& assets) {
    for (const CrowdWalkClips::Activity& entry : walks.activities) {
        if (entry.skeleton == skeleton && entry.activity == activity) {
            return entry.clip;
        }
    }
    const ClipId clip = {static_cast<std::uint32_t>(assets.clips.size())};
    assets.clips.push_back(make_activity_clip(assets.skeletons[skeleton.index], activity));
    walks.activities.push_back({skeleton, activity, clip});
    return clip;
}

/// Changes the clip and starts it at this part of it.
void play(ClipPlayer& player, ClipId clip, float phase, const Assets& assets) {
    if (player.clip != clip) {
        player.clip = clip;
        player.time = (phase - std::floor(phase)) * assets.clips[clip.index].duration;
        player.loop = true;
    }
}

}  // namespace

void add_crowd_scripts(
    Query<const CrowdScript, Without<CrowdScriptState>> bare, Commands commands) {
    bare.each([&](Entity entity, const CrowdScript&) { commands.add(entity, CrowdScriptState{}); });
}

void update_crowd_scripts(
    Query<
        const CrowdWalk, const Skeleton, ClipPlayer, Optional<const CrowdState>,
        Optional<const CrowdScript>, Optional<CrowdScriptState>>
        members,
    Res<Assets> assets, Res<CrowdWalkClips> walks) {
    members.each([&](const CrowdWalk& member, const Skeleton& skeleton, ClipPlayer& player,
                     const CrowdState* moved, const CrowdScript* script, CrowdScriptState* state) {
        const CrowdWalkClips::Entry* const walk = walks->find(skeleton.skeleton, member.style);
        if (walk == nullptr || (moved == nullptr && script == nullptr)) {
            return;
        }
        const float phase = finite_or(member.phase, 0.0f);
        const float speed = moved != nullptr ? glm::length(moved->velocity) : 0.0f;
        if (state != nullptr && script != nullptr) {
            state->walks = speed > (state->walks != 0 ? kStopSpeed : kStartSpeed) ? 1 : 0;
            if (state->walks == 0) {
                const CrowdActivity activity =
                    state->waving > 0 && script->activity != CrowdActivity::Sit
                        ? CrowdActivity::Wave
                        : script->activity;
                play(
                    player, find_activity(skeleton.skeleton, activity, *walks, *assets), phase,
                    *assets);
                player.speed = 1;
                return;
            }
        }
        play(player, walk->clip, phase, *assets);
        if (moved != nullptr) {
            player.speed = speed / walk->speed;
        }
    });
}

void notice_characters(
    Query<const CrowdScript, CrowdScriptState, const Transform, Optional<LookAt>> members,
    Query<const Transform> transforms, Res<const RandomSeed> seed, Res<const FrameTime> time,
    Commands commands) {
    members.each([&](Entity entity, const CrowdScript& script, CrowdScriptState& state,
                     const Transform& transform, LookAt* look) {
        const Transform* const other = transforms.find<const Transform>(script.notices);
        if (other == nullptr && state.attention <= 0) {
            return;
        }
        const float distance =
            other != nullptr ? glm::distance(other->position, transform.position) : INFINITY;
        const bool was_aware = state.aware != 0;
        // Nobody looks over the shoulder.
        const bool sees =
            other != nullptr
            && glm::dot(transform.rotation * Vec3(0, 0, 1), other->position - transform.position)
                   > kSideways * distance;
        const float within = script.notice_within * (was_aware ? kForget : 1.0f);
        state.aware = sees && distance < within ? 1 : 0;
        if (state.aware != 0 && !was_aware) {
            Random random(seed->seed, entity.bits(), name_hash("notice_characters"), time->frame);
            state.waving = random.uniform() < script.waves ? kWaveTime : 0.0f;
        }
        state.waving = std::max(state.waving - time->step, 0.0f);
        const float change = time->step / kAttentionTime;
        state.attention =
            std::clamp(state.attention + (state.aware != 0 ? change : -change), 0.0f, 1.0f);
        if (look != nullptr) {
            look->weight = state.attention;
            if (state.attention <= 0) {
                commands.remove<LookAt>(entity);
            }
        } else if (state.attention > 0) {
            LookAt looks;
            looks.target = script.notices;
            looks.position = {0, kEyeHeight, 0};
            looks.weight = state.attention;
            commands.add(entity, looks);
        }
    });
}

}  // namespace limn
