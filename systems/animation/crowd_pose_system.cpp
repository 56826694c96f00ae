#include "systems/animation/crowd_pose_system.h"

#include "ecs/base/log.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>

namespace limn {
namespace {

constexpr float kHysteresis = 1.1f;

Vec3 origin_of(const WorldTransform& transform) {
    const Affine& world = transform.world;
    return {world.row[0].w, world.row[1].w, world.row[2].w};
}

std::uint32_t interval_at(const CrowdPose& crowd, float distance) {
    return distance <= crowd.full_rate_within ? 1 : distance <= crowd.half_rate_within ? 2 : 4;
}

std::shared_ptr<const CrowdClip> compress(const SkeletonData& skeleton, const ClipData& clip) {
    Result<CrowdClip> packed = make_crowd_clip(skeleton, clip, scale_limits(skeleton));
    if (!packed) {
        log_warn("crowd_pose: {}; it is sampled as it is", packed.error().message);
        return nullptr;
    }
    return std::make_shared<const CrowdClip>(*std::move(packed));
}

}  // namespace

void add_crowd_poses(Query<const CrowdPose, Without<CrowdPoseState>> crowds, Commands commands) {
    crowds.each([&](Entity entity, const CrowdPose&) { commands.add(entity, CrowdPoseState{}); });
}

void prepare_crowd_clips(
    Query<const CrowdPose, const Skeleton, const ClipPlayer> crowds, Res<const Assets> assets,
    Res<CrowdLibrary> library) {
    crowds.each([&](const CrowdPose& crowd, const Skeleton& skeleton, const ClipPlayer& player) {
        const std::uint32_t rig = skeleton.skeleton.index;
        const std::uint32_t clip = player.clip.index;
        if (!crowd.compressed || rig >= assets->skeletons.size() || clip >= assets->clips.size()
            || library->find(skeleton.skeleton, player.clip) != nullptr) {
            return;
        }
        const SkeletonData& data = assets->skeletons[rig];
        if (library->rigs.size() <= rig) {
            library->rigs.resize(rig + 1);
        }
        if (library->rigs[rig] == nullptr) {
            library->rigs[rig] = std::make_shared<const CrowdRig>(make_crowd_rig(data));
        }
        if (library->clips.size() <= clip) {
            library->clips.resize(clip + 1);
        }
        library->clips[clip].push_back({skeleton.skeleton, compress(data, assets->clips[clip])});
    });
}

std::uint32_t choose_pose_interval(const CrowdPose& crowd, float distance, std::uint32_t current) {
    const std::uint32_t wanted = interval_at(crowd, distance);
    if (wanted > current) {
        return std::max(interval_at(crowd, distance / kHysteresis), current);
    }
    if (wanted < current) {
        return std::min(interval_at(crowd, distance * kHysteresis), current);
    }
    return wanted;
}

void fade_crowd_clips(Query<const ClipPlayer, CrowdPoseState> crowds, Res<const FrameTime> time) {
    const float part = time->step / kCrowdFade;
    crowds.each([&](const ClipPlayer& player, CrowdPoseState& state) {
        if (player.clip == state.clip) {
            state.fade = std::max(state.fade - part, 0.0f);
        } else if (state.clip != ClipId{}) {
            state.from = state.clip;
            state.from_time = state.time;
            state.fade = 1;
        }
        state.clip = player.clip;
        state.time = player.time;
    });
}

void choose_pose_rates(
    Query<const CrowdPose, const WorldTransform, CrowdPoseState> crowds,
    Query<const Camera, const WorldTransform> cameras) {
    bool found = false;
    Vec3 eye(0);
    cameras.each([&](const Camera& camera, const WorldTransform& transform) {
        if (camera.active && !found) {
            found = true;
            eye = origin_of(transform);
        }
    });
    if (!found) {
        return;
    }
    crowds.par_each(
        [eye](const CrowdPose& crowd, const WorldTransform& transform, CrowdPoseState& state) {
            const float distance = glm::distance(origin_of(transform), eye);
            state.interval = choose_pose_interval(crowd, distance, state.interval);
        });
}

}  // namespace limn
