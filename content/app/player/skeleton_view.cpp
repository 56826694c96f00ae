#include "content/app/player/skeleton_view.h"

#include "content/bake/motion/skeleton_motion.h"
#include "ecs/base/rotation.h"
#include "ecs/components/animation.h"
#include "ecs/components/foot_plant.h"
#include "ecs/components/ik.h"
#include "ecs/components/motion_graph.h"
#include "ecs/components/ragdoll.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/components/walk.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/pose_levels.h"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

// Techniques: char.fk-keypose, char.ghost-view

namespace limn {
namespace {

constexpr float kMomentsPerSecond = 60.0f;
constexpr std::size_t kAnyMorphs = 65536;  ///< they are not shown

/// Whether something besides a clip determines the pose.
bool is_modified(const World& world, Entity entity) {
    return world.has<MotionGraph>(entity) || world.has<Walk>(entity) || world.has<FootPlant>(entity)
           || world.has<IkRig>(entity) || world.has<LookAt>(entity) || world.has<ReachGoal>(entity)
           || world.has<RagdollState>(entity);
}

const ClipData*
clip_of(const World& world, Entity entity, const ClipPlayer* player, std::size_t joints) {
    if (is_modified(world, entity)) {
        return nullptr;
    }
    if (const auto* const keys = world.find<PoseKeysState>(entity)) {
        return &keys->clip;
    }
    const auto* const assets = world.find_resource<Assets>();
    if (player == nullptr || player->clip.index >= assets->clips.size()) {
        return nullptr;
    }
    const ClipData& clip = assets->clips[player->clip.index];
    return check_clip(clip, joints, kAnyMorphs).ok() ? &clip : nullptr;
}

Quat rotation_of_matrix(const Affine& a) {
    const Mat3 linear = glm::transpose(Mat3(Vec3(a.row[0]), Vec3(a.row[1]), Vec3(a.row[2])));
    return extract_rotation(linear).value_or(Quat(1, 0, 0, 0));
}

std::string axis_name(const Vec3& axis, std::size_t number) {
    const Vec3 size = glm::abs(axis);
    return size.x > 0.999f   ? "x"
           : size.y > 0.999f ? "y"
           : size.z > 0.999f ? "z"
                             : fmt::format("axis {}", number + 1);
}

/// The joint alone, from rest.
JointTree tree_of(const SkeletonData& skeleton, std::uint16_t joint) {
    const std::array<std::uint16_t, 1> joints = {joint};
    JointTree tree = make_joint_tree(skeleton, joints);
    tree.rests[0] = Quat(1, 0, 0, 0);
    return tree;
}

std::vector<JointAngle> free_angles(const Quat& turn) {
    const Mat3 m = glm::mat3_cast(turn);  // = Ry Rx Rz
    const float x = std::asin(std::clamp(-m[2][1], -1.0f, 1.0f));
    const bool locked = std::abs(m[2][1]) > 0.99999f;  // y and z turn about the same axis
    const float y = locked ? std::atan2(-m[0][2], m[0][0]) : std::atan2(m[2][0], m[2][2]);
    const float z = locked ? 0.0f : std::atan2(m[0][1], m[1][1]);
    return {
        {.name = "y", .axis = {0, 1, 0}, .value = y},
        {.name = "x", .axis = {1, 0, 0}, .value = x},
        {.name = "z", .axis = {0, 0, 1}, .value = z}};
}

}  // namespace

Entity find_character(const World& world, Entity entity) {
    for (Entity at = entity; world.alive(at); at = parent_of(world, at)) {
        if (world.has<Skeleton>(at)) {
            return at;
        }
        const auto* const deformed = world.find<Deformed>(at);
        if (deformed != nullptr && world.alive(deformed->character)
            && world.has<Skeleton>(deformed->character)) {
            return deformed->character;
        }
    }
    Entity only;
    int count = 0;
    world.query<const Skeleton>().each([&](Entity each, const Skeleton&) {
        only = each;
        ++count;
    });
    return count == 1 ? only : Entity{};
}

std::optional<CharacterView> view_character(const World& world, Entity entity) {
    const auto* const assets = world.find_resource<Assets>();
    if (assets == nullptr || !world.alive(entity)) {
        return std::nullopt;
    }
    const auto* const skeleton = world.find<Skeleton>(entity);
    const auto* const pose = world.find<Pose>(entity);
    const auto* const transform = world.find<WorldTransform>(entity);
    if (skeleton == nullptr || pose == nullptr || transform == nullptr
        || skeleton->skeleton.index >= assets->skeletons.size() || pose->joints.empty()) {
        return std::nullopt;
    }
    CharacterView view;
    view.entity = entity;
    view.skeleton = &assets->skeletons[skeleton->skeleton.index];
    view.world_from_character = transform->world;
    Pose whole = *pose;  // of the joints that a level of less detail leaves out, too
    resize_pose(*view.skeleton, view.skeleton->joints.size(), whole);
    view.joints = std::move(whole.joints);
    const auto* const player = world.find<ClipPlayer>(entity);
    view.clip = clip_of(world, entity, player, view.joints.size());
    if (player != nullptr) {
        view.time = player->time;
        view.speed = player->speed;
        view.loop = player->loop;
    }
    return view;
}

void MotionHistory::record(const CharacterView& view, double time) {
    if (view.entity != entity_ || (!moments_.empty() && time < moments_.back().time)) {
        moments_.clear();
        entity_ = view.entity;
    }
    if (!moments_.empty() && time == moments_.back().time) {
        return;
    }
    if (moments_.size() == kMoments) {
        moments_.erase(moments_.begin());
    }
    moments_.push_back({time, view.world_from_character, {view.joints.begin(), view.joints.end()}});
}

std::optional<CharacterMoment>
moment_at(const CharacterView& view, const MotionHistory& history, float offset) {
    if (view.clip != nullptr) {
        // Of a clip that stands still: where it would be if it played.
        const float speed = view.speed == 0.0f ? 1.0f : view.speed;
        const float time = view.time + offset * speed;
        const bool outside = time < -1e-3f || time > view.clip->duration + 1e-3f;
        if (outside && !view.loop) {
            return std::nullopt;
        }
        const LocalPose pose = sample_motion(
            *view.skeleton, *view.clip, clip_time(view.clip->duration, time, view.loop));
        CharacterMoment moment = {0.0, view.world_from_character, {}};
        moment.joints.resize(pose.size());
        compute_joint_matrices(*view.skeleton, pose, moment.joints);
        return moment;
    }
    const std::vector<CharacterMoment>& moments = history.moments();
    if (moments.empty() || offset > 0) {
        return std::nullopt;
    }
    const double time = moments.back().time + static_cast<double>(offset);
    if (time < moments.front().time - 1e-6) {
        return std::nullopt;
    }
    const auto nearest = std::min_element(
        moments.begin(), moments.end(), [time](const CharacterMoment& a, const CharacterMoment& b) {
            return std::abs(a.time - time) < std::abs(b.time - time);
        });
    return *nearest;
}

std::vector<Vec3> trail_of(
    const CharacterView& view, const MotionHistory& history, std::uint16_t joint, float before,
    float after) {
    std::vector<Vec3> trail;
    const int first = -static_cast<int>(before * kMomentsPerSecond);
    const int last = static_cast<int>(after * kMomentsPerSecond);
    for (int i = first; i <= last; ++i) {
        const auto moment = moment_at(view, history, static_cast<float>(i) / kMomentsPerSecond);
        if (moment && joint < moment->joints.size()) {
            trail.push_back(
                transform_point(moment->world_from_character * moment->joints[joint], Vec3(0)));
        }
    }
    return trail;
}

std::vector<JointAngle>
joint_angles(const SkeletonData& skeleton, std::uint16_t joint, const Quat& turn) {
    const bool is_free = std::ranges::none_of(
        skeleton.freedoms, [joint](const JointFreedom& freedom) { return freedom.joint == joint; });
    if (is_free) {
        return free_angles(turn);
    }
    const JointTree tree = tree_of(skeleton, joint);
    JointState state = zero_state(tree);
    set_local_rotation(tree, turn, 0, state);
    std::vector<JointAngle> angles;
    for (std::size_t a = 0; a < tree.axes.size(); ++a) {
        const JointAxis& axis = tree.axes[a];
        angles.push_back(
            {.name = axis_name(axis.axis, a),
             .axis = axis.axis,
             .value = state.values[a],
             .min = axis.min,
             .max = axis.max,
             .is_limited = true});
    }
    return angles;
}

Quat turn_of_angles(std::span<const JointAngle> angles) {
    Quat turn(1, 0, 0, 0);
    for (const JointAngle& angle : angles) {
        const float value =
            angle.is_limited ? std::clamp(angle.value, angle.min, angle.max) : angle.value;
        turn = turn * rotation_about(angle.axis, value);
    }
    return glm::normalize(turn);
}

Quat limit_turn(const SkeletonData& skeleton, std::uint16_t joint, const Quat& turn) {
    const std::vector<JointAngle> angles = joint_angles(skeleton, joint, turn);
    return angles.empty() || !angles.front().is_limited ? turn : turn_of_angles(angles);
}

Quat shown_turn(const SkeletonData& skeleton, std::span<const Affine> joints, std::uint16_t joint) {
    const std::int32_t parent = skeleton.parents[joint];
    const Quat above = parent < 0 ? Quat(1, 0, 0, 0)
                                  : rotation_of_matrix(joints[static_cast<std::size_t>(parent)]);
    return glm::normalize(
        glm::conjugate(above * skeleton.rest.rotations[joint]) * rotation_of_matrix(joints[joint]));
}

LocalPose local_pose(const SkeletonData& skeleton, std::span<const Affine> joints) {
    LocalPose pose = skeleton.rest;
    for (std::uint16_t j = 0; j < pose.size(); ++j) {
        pose.rotations[j] =
            glm::normalize(skeleton.rest.rotations[j] * shown_turn(skeleton, joints, j));
        const std::int32_t parent = skeleton.parents[j];
        const Vec3 at = transform_point(joints[j], Vec3(0));
        pose.translations[j] =
            parent < 0
                ? at
                : Vec3(
                    glm::inverse(to_mat4(joints[static_cast<std::size_t>(parent)])) * Vec4(at, 1));
    }
    return pose;
}

JointCurves curves_of(
    const CharacterView& view, const MotionHistory& history, std::uint16_t joint, float before,
    float after) {
    JointCurves found;
    const int first = -static_cast<int>(before * kMomentsPerSecond);
    const int last = static_cast<int>(after * kMomentsPerSecond);
    for (int i = first; i <= last; ++i) {
        const float offset = static_cast<float>(i) / kMomentsPerSecond;
        const auto moment = moment_at(view, history, offset);
        if (!moment || joint >= moment->joints.size()) {
            if (found.curves.empty()) {
                continue;
            }
            break;
        }
        const std::vector<JointAngle> angles =
            joint_angles(*view.skeleton, joint, shown_turn(*view.skeleton, moment->joints, joint));
        if (found.curves.empty()) {
            found.begin = offset;
            for (const JointAngle& angle : angles) {
                found.curves.push_back({angle.name, {}});
            }
        }
        for (std::size_t c = 0; c < angles.size(); ++c) {
            found.curves[c].values.push_back(angles[c].value * 180.0f / kPi);
        }
    }
    return found;
}

}  // namespace limn
