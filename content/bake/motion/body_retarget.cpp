#include "content/bake/motion/body_retarget.h"

#include "content/bake/motion/body_frame.h"
#include "content/bake/motion/foot_pins.h"
#include "ecs/base/text.h"
#include "ecs/components/body_map.h"
#include "ecs/components/body_measures.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

// Techniques: char.retarget-body

namespace limn {
namespace {

constexpr float kFloorBand = 0.12f;  ///< feet this low stand on y = 0 [leg lengths]

/// Copies the rotations of all frames.
MotionFrames copy_rotations(
    const BodyMap& map, const SkeletonMotion& source, const SkeletonData& target,
    const MotionFrames& frames) {
    MotionFrames copied;
    copied.rate = frames.rate;
    copied.joints = target.joints.size();
    LocalPose pose = target.rest;
    std::vector<Quat> outer;
    for (std::size_t f = 0; f < frames.frames(); ++f) {
        const std::vector<Quat> turns = find_frame_rotations(
            source.skeleton, std::span(frames.rotations).subspan(f * frames.joints, frames.joints));
        map_body_turns(map, target, turns, outer, pose.rotations);
        copied.rotations.insert(
            copied.rotations.end(), pose.rotations.begin(), pose.rotations.end());
        copied.translations.insert(
            copied.translations.end(), pose.translations.begin(), pose.translations.end());
        copied.scales.insert(copied.scales.end(), pose.scales.begin(), pose.scales.end());
    }
    return copied;
}

/// Height of the ground in a recording: y = 0, unless neither the rest pose nor the motion are
/// there.
float find_ground(const BodySize& source, const MotionFrames& frames) {
    if (source.leg <= 0 || source.stands_on_zero) {
        return 0;
    }
    float lowest = INFINITY;
    for (std::size_t f = 0; f < frames.frames(); ++f) {
        lowest =
            std::min(lowest, source.find_lowest(find_frame_joints(source.skeleton, frames, f)));
    }
    const float band = kFloorBand * source.leg;
    return std::abs(lowest) < band                  ? 0.0f
           : std::abs(lowest - source.floor) < band ? source.floor
                                                    : lowest;
}

/// Moves the hips of all frames as those of the source, scaled.
void copy_way(
    const BodySize& source, const BodySize& target, const MotionFrames& frames, float scale,
    const Vec3& shift, MotionFrames& copied) {
    for (std::size_t f = 0; f < frames.frames(); ++f) {
        const Vec3 wanted =
            scale * source.middle(find_frame_joints(source.skeleton, frames, f)) + shift;
        const Vec3 found = target.middle(find_frame_joints(target.skeleton, copied, f));
        move_joint(target.skeleton, copied, f, target.root, wanted - found);
    }
}

/// The contacts for joints of the target; those of joints that it lacks are dropped.
std::vector<ClipContact> translate_contacts(
    std::span<const ClipContact> contacts, const BodySize& source, const BodySize& target,
    std::span<const FollowedJoint> followed) {
    std::vector<ClipContact> translated;
    for (ClipContact contact : contacts) {
        std::optional<std::uint16_t> joint;
        for (std::size_t p = 0; p < kBodyParts && !joint; ++p) {
            const auto part = static_cast<BodyPart>(p);
            if (source.joints[part] == contact.joint && target.joints.has(part)) {
                joint = target.joints[part];
            }
        }
        for (std::size_t j = 0; j < followed.size() && !joint; ++j) {
            if (followed[j].first == contact.joint && followed[j].u == 0) {
                joint = static_cast<std::uint16_t>(j);
            }
        }
        if (joint) {
            contact.joint = *joint;
            translated.push_back(contact);
        }
    }
    return translated;
}

/// Whether the target is the source, larger or smaller.
bool is_scaled_copy(const SkeletonData& source, const SkeletonData& target, float scale) {
    if (source.joints != target.joints || source.parents != target.parents) {
        return false;
    }
    for (std::size_t j = 0; j < source.joints.size(); ++j) {
        const Vec3 expected = scale * source.rest.translations[j];
        const float size = glm::length(expected) + 1e-3f;
        const bool is_same =
            glm::distance(expected, target.rest.translations[j]) < 1e-4f * size
            && std::abs(glm::dot(source.rest.rotations[j], target.rest.rotations[j])) > 1 - 1e-6f;
        if (!is_same) {
            return false;
        }
    }
    return true;
}

/// Lets hands follow the scaled way of the source's.
void move_hands(
    const BodySize& source, const BodySize& target, const MotionFrames& frames, float scale,
    const Vec3& shift, float importance, MotionFrames& copied) {
    for (const auto& [arm, forearm, hand] :
         {std::array{BodyPart::LeftUpperArm, BodyPart::LeftForearm, BodyPart::LeftHand},
          std::array{BodyPart::RightUpperArm, BodyPart::RightForearm, BodyPart::RightHand}}) {
        const BodyJoints& joints = target.joints;
        if (!source.joints.has(hand) || !joints.has(arm) || !joints.has(forearm)
            || !joints.has(hand)) {
            continue;
        }
        for (std::size_t f = 0; f < frames.frames(); ++f) {
            const Vec3 wanted =
                scale
                    * transform_point(
                        find_frame_joints(source.skeleton, frames, f)[source.joints[hand]], Vec3(0))
                + shift;
            const Vec3 found = transform_point(
                find_frame_joints(target.skeleton, copied, f)[joints[hand]], Vec3(0));
            reach_with_limb(
                target.skeleton, copied, f, {joints[arm], joints[forearm], joints[hand]},
                glm::mix(found, wanted, importance), Vec3(0, 1, 0));
        }
    }
}

/// The first names, for messages.
std::string first_joints(const SkeletonData& skeleton) {
    constexpr std::size_t kShown = 5;
    const std::span<const std::string> names(skeleton.joints);
    return join_text(names.first(std::min(kShown, names.size())), ", ")
           + (names.size() > kShown ? " ..." : "");
}

}  // namespace

std::vector<std::int32_t> match_joints(const SkeletonData& source, const SkeletonData& target) {
    std::vector<std::int32_t> joints;
    for (const FollowedJoint& followed : match_body_joints(source, target)) {
        joints.push_back(followed.u < 0.5f ? followed.first : followed.second);
    }
    return joints;
}

float find_slide(
    const SkeletonData& skeleton, const MotionFrames& frames,
    std::span<const ClipContact> contacts) {
    float slide = 0;
    for (const ClipContact& contact : contacts) {
        const auto begin = static_cast<std::size_t>(std::lround(contact.begin * frames.rate));
        const auto last = static_cast<std::size_t>(std::lround(contact.end * frames.rate));
        std::optional<Vec3> first;
        for (std::size_t f = begin; f <= last && f < frames.frames(); ++f) {
            const Vec3 at =
                transform_point(find_frame_joints(skeleton, frames, f)[contact.joint], Vec3(0));
            first = first.value_or(at);
            slide = std::max(slide, glm::distance(at, *first));
        }
    }
    return slide;
}

Result<ClipData> retarget_motion(
    const SkeletonMotion& source, const SkeletonData& target, const RetargetOptions& options,
    RetargetReport* report) {
    const BodySize from(source.skeleton);
    const BodySize to(target);
    const BodyMap map = make_body_map(from, to);
    RetargetReport made;
    made.joints = map.count();
    const std::size_t smaller = std::min(source.skeleton.joints.size(), target.joints.size());
    if (made.joints < std::min<std::size_t>(2, smaller)) {  // one would only be moved
        return fail(
            "found {} between {} and {}, expected equal names or parts of a body such as LeftUpLeg "
            "or thigh.L",
            made.joints == 0 ? "no joints that correspond" : "only one joint that corresponds",
            first_joints(source.skeleton), first_joints(target));
    }
    made.scale = map.scale;
    LIMN_TRY(check_pose_count(source, find_motion_rate(source.clip)));
    const MotionFrames frames = sample_frames(source, find_motion_rate(source.clip));
    MotionFrames copied = copy_rotations(map, source, target, frames);
    const Vec3 shift = find_body_shift(from, to, made.scale, find_ground(from, frames));
    copy_way(from, to, frames, made.scale, shift, copied);
    if (options.hands > 0) {
        move_hands(from, to, frames, made.scale, shift, options.hands, copied);
    }
    ClipData like = source.clip;
    if (like.contacts.empty()) {
        like.contacts = detect_contacts(
            source.skeleton, frames, find_foot_joints(from.joints), options.contacts);
    }
    like.contacts = translate_contacts(like.contacts, from, to, map.followed);
    made.slide_before = find_slide(target, copied, like.contacts);
    if (options.pin_feet && !is_scaled_copy(source.skeleton, target, made.scale)) {
        const FootPins pins = pin_feet(target, to.joints, copied, like.contacts, options.fade);
        made.contacts = pins.contacts;
        made.lowered = pins.lowered;
    }
    made.slide = find_slide(target, copied, like.contacts);
    if (report != nullptr) {
        *report = made;
    }
    return make_frames_clip(target, copied, like);
}

}  // namespace limn
