#include "content/bake/motion/pose_editing.h"

#include "content/bake/motion/skeleton_motion.h"
#include "ecs/base/check.h"
#include "ecs/base/rotation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

// Techniques: anim.pose-keys, char.fk-keypose

namespace limn {
namespace {

/// Differences from the rest pose below this are none: rounding of unit quaternions.
constexpr float kAtRest = 1e-6f;

bool is_at_rest(const KeyedJoint& posed) {
    return glm::length(Vec3(posed.turn.x, posed.turn.y, posed.turn.z)) <= kAtRest
           && glm::length(posed.shift) <= kAtRest;
}

/// The first key that is not before `time`.
auto key_from(std::vector<PoseKey>& keys, float time) {
    return std::find_if(keys.begin(), keys.end(), [time](const PoseKey& key) {
        return key.time > time - kSameKeyTime;
    });
}

struct SideNames {
    std::string_view left;
    std::string_view right;
};
constexpr std::array<SideNames, 8> kSideNames = {
    {{"Left", "Right"},
     {"left", "right"},
     {".L", ".R"},
     {".l", ".r"},
     {"_L_", "_R_"},
     {"_L", "_R"},
     {"_l", "_r"},
     {"-l", "-r"}}};

/// The name with its side exchanged; the same where it has none. Short marks count at the end only.
std::string mirror_name(const std::string& name) {
    const auto exchange = [&](std::string_view from, std::string_view to) {
        const std::size_t at = name.rfind(from);
        const bool is_mark = from.size() == 2;
        if (at == std::string::npos || (is_mark && at + from.size() != name.size())) {
            return std::string();
        }
        return name.substr(0, at) + std::string(to) + name.substr(at + from.size());
    };
    for (const SideNames& side : kSideNames) {
        for (const auto& [from, to] :
             {std::pair(side.left, side.right), std::pair(side.right, side.left)}) {
            if (std::string mirrored = exchange(from, to); !mirrored.empty()) {
                return mirrored;
            }
        }
    }
    return name;
}

std::vector<Quat> rest_orientations(const SkeletonData& skeleton) {
    std::vector<Quat> all;
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        const std::int32_t parent = skeleton.parents[j];
        const Quat& local = skeleton.rest.rotations[j];
        all.push_back(
            parent < 0 ? local : glm::normalize(all[static_cast<std::size_t>(parent)] * local));
    }
    return all;
}

Quat parent_orientation(
    const SkeletonData& skeleton, const std::vector<Quat>& rests, std::size_t joint) {
    const std::int32_t parent = skeleton.parents[joint];
    return parent < 0 ? Quat(1, 0, 0, 0) : rests[static_cast<std::size_t>(parent)];
}

}  // namespace

std::optional<std::size_t> find_pose_key(const PoseKeys& keys, float time) {
    const auto found = std::ranges::find_if(
        keys.keys, [time](const PoseKey& key) { return std::abs(key.time - time) < kSameKeyTime; });
    return found == keys.keys.end()
               ? std::nullopt
               : std::optional(static_cast<std::size_t>(found - keys.keys.begin()));
}

LocalPose sample_pose_keys(const SkeletonData& skeleton, const PoseKeys& keys, float time) {
    const Result<ClipData> clip = make_pose_clip(skeleton, keys);
    return clip ? sample_motion(skeleton, *clip, time) : skeleton.rest;
}

void set_pose_key(PoseKeys& keys, const SkeletonData& skeleton, float time, const LocalPose& pose) {
    LIMN_CHECK(time >= 0);
    const auto at = key_from(keys.keys, time);
    const bool exists = at != keys.keys.end() && at->time < time + kSameKeyTime;
    PoseKey& key = exists ? *at : *keys.keys.insert(at, PoseKey{.time = time});
    key.joints.clear();
    for (std::uint16_t j = 0; j < pose.size(); ++j) {
        KeyedJoint posed = keyed_joint(skeleton, pose, j);
        if (!is_at_rest(posed)) {
            key.joints.push_back(std::move(posed));
        }
    }
}

bool remove_pose_key(PoseKeys& keys, float time) {
    const std::optional<std::size_t> found = find_pose_key(keys, time);
    if (found) {
        keys.keys.erase(keys.keys.begin() + static_cast<std::ptrdiff_t>(*found));
    }
    return found.has_value();
}

KeyedJoint keyed_joint(const SkeletonData& skeleton, const LocalPose& pose, std::uint16_t joint) {
    const Quat turn =
        glm::normalize(glm::conjugate(skeleton.rest.rotations[joint]) * pose.rotations[joint]);
    return {
        skeleton.joints[joint], turn.w < 0 ? -turn : turn,
        pose.translations[joint] - skeleton.rest.translations[joint]};
}

void turn_joint(
    const SkeletonData& skeleton, std::uint16_t joint, const Quat& turn, LocalPose& pose) {
    pose.rotations[joint] = glm::normalize(skeleton.rest.rotations[joint] * turn);
}

float snap_angle(float angle, float step) {
    return step > 0 ? step * std::round(angle / step) : angle;
}

std::vector<std::uint16_t> mirrored_joints(const SkeletonData& skeleton) {
    std::vector<std::uint16_t> others;
    for (std::uint16_t j = 0; j < skeleton.joints.size(); ++j) {
        const std::string name = mirror_name(skeleton.joints[j]);
        const auto found = std::ranges::find(skeleton.joints, name);
        others.push_back(
            found == skeleton.joints.end()
                ? j
                : static_cast<std::uint16_t>(found - skeleton.joints.begin()));
    }
    // Only pairs: of two joints with one mirror image, the second is its own.
    for (std::uint16_t j = 0; j < others.size(); ++j) {
        if (others[others[j]] != j) {
            others[j] = j;
        }
    }
    return others;
}

LocalPose mirror_pose(const SkeletonData& skeleton, const LocalPose& pose) {
    const std::vector<std::uint16_t> others = mirrored_joints(skeleton);
    const std::vector<Quat> rests = rest_orientations(skeleton);
    LocalPose mirrored = pose;
    for (std::uint16_t j = 0; j < pose.size(); ++j) {
        const std::uint16_t other = others[j];
        const KeyedJoint from = keyed_joint(skeleton, pose, other);
        const Quat seen = rests[other] * from.turn * glm::conjugate(rests[other]);
        const Quat reflected(seen.w, seen.x, -seen.y, -seen.z);
        turn_joint(skeleton, j, glm::conjugate(rests[j]) * reflected * rests[j], mirrored);
        const Vec3 shift = parent_orientation(skeleton, rests, other) * from.shift;
        mirrored.translations[j] = skeleton.rest.translations[j]
                                   + glm::conjugate(parent_orientation(skeleton, rests, j))
                                         * Vec3(-shift.x, shift.y, shift.z);
    }
    return mirrored;
}

}  // namespace limn
