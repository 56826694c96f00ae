#include "content/bake/motion/body_retarget.h"

#include "content/bake/motion/body_frame.h"
#include "content/bake/motion/foot_pins.h"
#include "ecs/base/limb_reach.h"
#include "ecs/base/rotation.h"
#include "ecs/base/text.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

// Techniques: char.retarget-body

namespace limn {
namespace {

constexpr float kSameFacing = radians(10.0f);  ///< bodies that face less apart face the same way
constexpr float kFloorBand = 0.12f;            ///< feet this low stand on y = 0 [leg lengths]

/// What a joint of the target follows: between two joints of the source.
struct Followed {
    std::int32_t first = -1;  ///< -1: nothing
    std::int32_t second = -1;
    float u = 0;
};

/// The joints from `below`, an ancestor, to `top`; empty if it is none.
std::vector<std::uint16_t>
list_chain_between(const SkeletonData& skeleton, std::uint16_t below, std::uint16_t top) {
    std::vector<std::uint16_t> chain;
    for (std::int32_t j = top; j >= 0; j = skeleton.parents[static_cast<std::size_t>(j)]) {
        chain.push_back(static_cast<std::uint16_t>(j));
        if (chain.back() == below) {
            std::reverse(chain.begin(), chain.end());
            return chain;
        }
    }
    return {};
}

class JointMatcher {
  public:
    JointMatcher(const SkeletonData& source, const SkeletonData& target)
        : source_(source), target_(target), source_body_(find_body_joints(source)),
          target_body_(find_body_joints(target)), found_(target.joints.size()) {}

    std::vector<Followed> match() {
        match_chain(BodyPart::Spine, BodyPart::Chest);
        match_chain(BodyPart::Neck, BodyPart::Head);
        for (std::size_t p = 0; p < kBodyParts; ++p) {
            const auto part = static_cast<BodyPart>(p);
            if (source_body_.has(part) && target_body_.has(part)) {
                follow(target_body_[part], source_body_[part]);
            }
        }
        const std::uint16_t root = find_body_root(target_, target_body_);
        if (has_any()) {
            follow(root, find_body_root(source_, source_body_));
        }
        for (std::size_t j = 0; j < target_.joints.size(); ++j) {
            const auto named =
                std::find(source_.joints.begin(), source_.joints.end(), target_.joints[j]);
            if (named != source_.joints.end() && !target_.joints[j].empty()) {
                follow(
                    static_cast<std::uint16_t>(j),
                    static_cast<std::uint16_t>(named - source_.joints.begin()));
            }
        }
        return found_;
    }

  private:
    void follow(std::uint16_t target, std::uint16_t source) {
        if (found_[target].first < 0) {
            found_[target] = {source, source, 0};
        }
    }

    [[nodiscard]] bool has_any() const {
        return std::any_of(
            found_.begin(), found_.end(), [](const Followed& f) { return f.first >= 0; });
    }

    /// Shares the bend of a chain among other numbers of joints.
    void match_chain(BodyPart below, BodyPart top) {
        for (const BodyJoints* body : {&source_body_, &target_body_}) {
            if (!body->has(below) || !body->has(top)) {
                return;
            }
        }
        const auto from = list_chain_between(source_, source_body_[below], source_body_[top]);
        const auto to = list_chain_between(target_, target_body_[below], target_body_[top]);
        for (std::size_t i = 0; i < to.size() && !from.empty(); ++i) {
            const float t =
                to.size() < 2 ? 1.0f : static_cast<float>(i) / static_cast<float>(to.size() - 1);
            const float exact = t * static_cast<float>(from.size() - 1);
            const float nearest = std::round(exact);
            const float at = std::abs(exact - nearest) < 1e-4f ? nearest : exact;
            const auto first = static_cast<std::size_t>(at);
            const std::size_t second = std::min(first + 1, from.size() - 1);
            found_[to[i]] = {from[first], from[second], at - static_cast<float>(first)};
        }
    }

    const SkeletonData& source_;
    const SkeletonData& target_;
    BodyJoints source_body_;
    BodyJoints target_body_;
    std::vector<Followed> found_;
};

/// A skeleton with what retargeting measures on it.
struct Body {
    const SkeletonData& skeleton;
    BodyJoints joints;
    std::vector<Affine> rest;          ///< skeleton_from_joint
    std::vector<Quat> rest_rotations;  ///< in the space of the skeleton
    std::uint16_t root = 0;
    float leg = 0;               ///< length [m]; 0: none, nor the following
    std::vector<bool> is_foot;   ///< ankles and all below
    bool stands_on_zero = true;  ///< at rest; else somewhere else, as on the hips' height
    float floor = 0;             ///< the lowest joint of the feet at rest, or y = 0 [m]
    float ankle = 0;             ///< height of the ankles above it [m]

    explicit Body(const SkeletonData& of)
        : skeleton(of), joints(find_body_joints(of)), rest(find_rest_matrices(of)),
          rest_rotations(find_frame_rotations(of, of.rest.rotations)),
          root(find_body_root(of, joints)), leg(find_leg_length(of, joints)) {
        if (leg > 0) {
            measure_feet();
        }
    }

    [[nodiscard]] Vec3 rest_position(std::uint16_t joint) const {
        return transform_point(rest[joint], Vec3(0));
    }

    /// Height of the lowest joint of the feet.
    [[nodiscard]] float find_lowest(const std::vector<Affine>& matrices) const {
        float lowest = INFINITY;
        for (std::size_t j = 0; j < matrices.size(); ++j) {
            if (is_foot[j]) {
                lowest = std::min(lowest, transform_point(matrices[j], Vec3(0)).y);
            }
        }
        return lowest;
    }

    /// Midpoint of the hips, or the root without legs.
    [[nodiscard]] Vec3 middle(const std::vector<Affine>& matrices) const {
        if (!joints.has(BodyPart::LeftThigh) || !joints.has(BodyPart::RightThigh)) {
            return transform_point(matrices[root], Vec3(0));
        }
        return 0.5f
               * (transform_point(matrices[joints[BodyPart::LeftThigh]], Vec3(0))
                  + transform_point(matrices[joints[BodyPart::RightThigh]], Vec3(0)));
    }

  private:
    void measure_feet() {
        float ankles = 0;
        float count = 0;
        is_foot.assign(rest.size(), false);
        for (const BodyPart part : {BodyPart::LeftFoot, BodyPart::RightFoot}) {
            if (joints.has(part)) {
                is_foot[joints[part]] = true;
                ankles += rest_position(joints[part]).y;
                count += 1;
            }
        }
        for (std::size_t j = 1; j < rest.size(); ++j) {
            is_foot[j] = is_foot[j] || is_foot[static_cast<std::size_t>(skeleton.parents[j])];
        }
        const float lowest = find_lowest(rest);
        stands_on_zero = lowest >= 0 && lowest < kFloorBand * leg;
        floor = stands_on_zero ? 0.0f : lowest;
        ankle = ankles / count - floor;
    }
};

/// Rotation about the vertical by which the target faces as the source does.
Quat find_facing(const Body& source, const Body& target) {
    const Vec3 from = find_left(target.skeleton, target.joints);
    const Vec3 to = find_left(source.skeleton, source.joints);
    const float angle = std::atan2(glm::cross(from, to).y, glm::dot(from, to));
    return std::abs(angle) < kSameFacing ? Quat(1, 0, 0, 0) : rotation_about({0, 1, 0}, angle);
}

/// For each joint of the target: turns its rest pose, limb by limb, into that of the source.
std::vector<Quat> find_alignments(const Body& source, const Body& target, const Quat& facing) {
    std::vector<Quat> alignments(target.rest.size(), facing);
    std::vector<bool> is_limb(target.rest.size(), false);
    const auto align = [&](BodyPart part, BodyPart next) {
        const bool has = source.joints.has(part) && source.joints.has(next)
                         && target.joints.has(part) && target.joints.has(next);
        if (!has) {
            return;
        }
        const auto along = [&](const Body& body) {
            return normalize_or(
                body.rest_position(body.joints[next]) - body.rest_position(body.joints[part]),
                Vec3(0));
        };
        const Vec3 from = facing * along(target);
        const Vec3 to = along(source);
        if (from != Vec3(0) && to != Vec3(0)) {
            alignments[target.joints[part]] = shortest_arc(from, to) * facing;
            is_limb[target.joints[part]] = true;
        }
    };
    // Not feet: their soles are flat in both rest poses.
    align(BodyPart::LeftUpperArm, BodyPart::LeftForearm);
    align(BodyPart::LeftForearm, BodyPart::LeftHand);
    align(BodyPart::RightUpperArm, BodyPart::RightForearm);
    align(BodyPart::RightForearm, BodyPart::RightHand);
    align(BodyPart::LeftThigh, BodyPart::LeftShin);
    align(BodyPart::LeftShin, BodyPart::LeftFoot);
    align(BodyPart::RightThigh, BodyPart::RightShin);
    align(BodyPart::RightShin, BodyPart::RightFoot);
    const auto is_foot = [&](std::size_t j) {
        return j == target.joints[BodyPart::LeftFoot] || j == target.joints[BodyPart::RightFoot];
    };
    for (std::size_t j = 1; j < alignments.size(); ++j) {  // hands and fingers as forearms
        const auto parent = static_cast<std::size_t>(target.skeleton.parents[j]);
        if (!is_limb[j] && !is_foot(j) && is_limb[parent]) {
            alignments[j] = alignments[parent];
            is_limb[j] = true;
        }
    }
    return alignments;
}

/// Copies the rotations of all frames.
MotionFrames copy_rotations(
    const Body& source, const Body& target, const MotionFrames& frames,
    std::span<const Followed> followed) {
    const std::vector<Quat> alignments =
        find_alignments(source, target, find_facing(source, target));
    MotionFrames copied;
    copied.rate = frames.rate;
    copied.joints = target.rest.size();
    const LocalPose& rest = target.skeleton.rest;
    for (std::size_t f = 0; f < frames.frames(); ++f) {
        const std::vector<Quat> rotations = find_frame_rotations(
            source.skeleton, std::span(frames.rotations).subspan(f * frames.joints, frames.joints));
        const auto turned = [&](std::int32_t j) {
            const auto i = static_cast<std::size_t>(j);
            return rotations[i] * glm::conjugate(source.rest_rotations[i]);
        };
        std::vector<Quat> made;
        for (std::size_t j = 0; j < copied.joints; ++j) {
            const std::int32_t parent = target.skeleton.parents[j];
            const Quat outer =
                parent < 0 ? Quat(1, 0, 0, 0) : made[static_cast<std::size_t>(parent)];
            Quat local = rest.rotations[j];
            if (followed[j].first >= 0) {
                const Quat turn =
                    slerp(turned(followed[j].first), turned(followed[j].second), followed[j].u);
                local = glm::normalize(
                    glm::conjugate(outer) * turn * alignments[j] * target.rest_rotations[j]);
                const Quat& previous =
                    f > 0 ? copied.rotations[(f - 1) * copied.joints + j] : rest.rotations[j];
                local = to_same_hemisphere(previous, local);
            }
            made.push_back(outer * local);
            copied.rotations.push_back(local);
        }
        copied.translations.insert(
            copied.translations.end(), rest.translations.begin(), rest.translations.end());
        copied.scales.insert(copied.scales.end(), rest.scales.begin(), rest.scales.end());
    }
    return copied;
}

/// Height of the ground in a recording: y = 0, unless neither the rest pose nor the motion are
/// there.
float find_ground(const Body& source, const MotionFrames& frames) {
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

/// From scaled positions of the source to those of the target: the ankles of a standing person are
/// at their own height above the ground.
Vec3 find_shift(const Body& source, const Body& target, const MotionFrames& frames, float scale) {
    if (source.leg <= 0 || target.leg <= 0) {
        return target.rest_position(target.root) - scale * source.rest_position(source.root);
    }
    const float ground = scale * find_ground(source, frames);
    const float raised = target.stands_on_zero ? -ground : 0.0f;
    return {0, raised + target.ankle - scale * source.ankle, 0};
}

/// Moves the hips of all frames as those of the source, scaled.
void copy_way(
    const Body& source, const Body& target, const MotionFrames& frames, float scale,
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
    std::span<const ClipContact> contacts, const Body& source, const Body& target,
    std::span<const Followed> followed) {
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
    const Body& source, const Body& target, const MotionFrames& frames, float scale,
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

}  // namespace

std::vector<std::int32_t> match_joints(const SkeletonData& source, const SkeletonData& target) {
    std::vector<std::int32_t> joints;
    for (const Followed& followed : JointMatcher(source, target).match()) {
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
    const std::vector<Followed> followed = JointMatcher(source.skeleton, target).match();
    RetargetReport made;
    made.joints = static_cast<std::size_t>(std::count_if(
        followed.begin(), followed.end(), [](const Followed& f) { return f.first >= 0; }));
    const std::size_t smaller = std::min(source.skeleton.joints.size(), target.joints.size());
    if (made.joints < std::min<std::size_t>(2, smaller)) {  // one would only be moved
        return fail(
            "found {} joints that correspond: {} ... and {} ..., expected equal names or parts of "
            "a body such as LeftUpLeg or thigh.L",
            made.joints == 0 ? "no" : "one of the", source.skeleton.joints[0], target.joints[0]);
    }
    const Body from(source.skeleton);
    const Body to(target);
    made.scale = from.leg > 0 && to.leg > 0 ? to.leg / from.leg : 1.0f;
    LIMN_TRY(check_pose_count(source, find_motion_rate(source.clip)));
    const MotionFrames frames = sample_frames(source, find_motion_rate(source.clip));
    MotionFrames copied = copy_rotations(from, to, frames, followed);
    const Vec3 shift = find_shift(from, to, frames, made.scale);
    copy_way(from, to, frames, made.scale, shift, copied);
    if (options.hands > 0) {
        move_hands(from, to, frames, made.scale, shift, options.hands, copied);
    }
    ClipData like = source.clip;
    if (like.contacts.empty()) {
        like.contacts = detect_contacts(
            source.skeleton, frames, find_foot_joints(from.joints), options.contacts);
    }
    like.contacts = translate_contacts(like.contacts, from, to, followed);
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
