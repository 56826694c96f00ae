#include "systems/animation/crowd_pose_system.h"

#include "ecs/base/log.h"
#include "systems/animation/pose_levels.h"

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

void add_rig(
    SkeletonId skeleton, const SkeletonData& data, std::size_t joints, CrowdLibrary& library) {
    if (library.find_rig(skeleton, joints) == nullptr) {
        library.rigs.resize(std::max<std::size_t>(library.rigs.size(), skeleton.index + 1));
        library.rigs[skeleton.index].push_back(
            std::make_shared<const CrowdRig>(make_crowd_rig(data, joints)));
    }
}

/// Looked up by mesh, so that the weights are read once.
std::uint32_t
find_needed_joints(MeshId mesh, SkinId skin, const Assets& assets, CrowdLibrary& library) {
    if (mesh.index >= assets.meshes.size() || skin.index >= assets.skins.size()) {
        return 0;
    }
    library.needs.resize(std::max<std::size_t>(library.needs.size(), mesh.index + 1));
    CrowdLibrary::Need& need = library.needs[mesh.index];
    const MeshData& data = assets.meshes[mesh.index];
    if (need.skin != skin || need.version != data.version) {
        need = {
            data.version, skin,
            static_cast<std::uint32_t>(needed_joints(data.skin, assets.skins[skin.index]))};
    }
    return need.joints;
}

}  // namespace

void add_crowd_poses(Query<const CrowdPose, Without<CrowdPoseState>> crowds, Commands commands) {
    crowds.each([&](Entity entity, const CrowdPose&) { commands.add(entity, CrowdPoseState{}); });
}

void prepare_crowd_clips(
    Query<const CrowdPose, const Skeleton, const ClipPlayer, Optional<const CrowdPoseState>> crowds,
    Res<const Assets> assets, Res<CrowdLibrary> library) {
    SkeletonId last_skeleton;
    ClipId last_clip;
    std::uint32_t last_joints = 0;
    crowds.each([&](const CrowdPose& crowd, const Skeleton& skeleton, const ClipPlayer& player,
                    const CrowdPoseState* state) {
        const std::uint32_t clip = player.clip.index;
        const std::uint32_t needed = state != nullptr ? state->joints : 0;
        if (skeleton.skeleton == last_skeleton && player.clip == last_clip
            && needed == last_joints) {
            return;  // as most neighbors are
        }
        if (!crowd.compressed || skeleton.skeleton.index >= assets->skeletons.size()
            || clip >= assets->clips.size()) {
            return;
        }
        last_skeleton = skeleton.skeleton;
        last_clip = player.clip;
        last_joints = needed;
        const SkeletonData& data = assets->skeletons[skeleton.skeleton.index];
        add_rig(skeleton.skeleton, data, posed_joints(state, data), *library);
        if (library->find(skeleton.skeleton, player.clip) == nullptr) {
            library->clips.resize(std::max<std::size_t>(library->clips.size(), clip + 1));
            library->clips[clip].push_back(
                {skeleton.skeleton, compress(data, assets->clips[clip])});
        }
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

void choose_pose_joints(
    Query<const CrowdPose, const Skeleton, CrowdPoseState, Pose> crowds,
    Query<const Deformed, const MeshInstance> meshes,
    Query<const Deformed, const ControlSurface> surfaces, Query<const JointAttachment> attachments,
    Res<const Assets> assets, Res<CrowdLibrary> library) {
    if (crowds.empty()) {
        return;
    }
    const auto need = [&crowds](Entity character, std::uint32_t joints) {
        if (auto* const state = crowds.find<CrowdPoseState>(character)) {
            state->joints = std::max(state->joints, joints);
        }
    };
    crowds.each([](const CrowdPose&, const Skeleton&, CrowdPoseState& state, const Pose&) {
        state.joints = 0;
    });
    meshes.each([&](const Deformed& deformed, const MeshInstance& instance) {
        need(
            deformed.character,
            find_needed_joints(instance.mesh, deformed.skin, *assets, *library));
    });
    surfaces.each([&](const Deformed& deformed, const ControlSurface& surface) {
        need(
            deformed.character, find_needed_joints(surface.mesh, deformed.skin, *assets, *library));
    });
    attachments.each([&](const JointAttachment& attachment) {
        need(attachment.character, attachment.joint + 1u);
    });
    crowds.each([&](const CrowdPose&, const Skeleton& skeleton, CrowdPoseState& state, Pose& pose) {
        if (skeleton.skeleton.index >= assets->skeletons.size() || state.joints == 0) {
            return;
        }
        const SkeletonData& data = assets->skeletons[skeleton.skeleton.index];
        const std::size_t joints = posed_joints(&state, data);
        if (!pose.joints.empty() && pose.joints.size() < joints) {
            resize_pose(data, joints, pose);
        }
    });
}

}  // namespace limn
