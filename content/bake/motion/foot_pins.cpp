#include "content/bake/motion/foot_pins.h"

#include "content/bake/motion/body_frame.h"
#include "ecs/base/limb_reach.h"
#include "ecs/base/rotation.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

// Techniques: char.retarget-body

namespace limn {
namespace {

constexpr float kMaxReach = 0.9999f;  ///< of the leg's length: a straight leg is hard to control

Vec3 position_in(const std::vector<Affine>& joints, std::uint16_t joint) {
    return transform_point(joints[joint], Vec3(0));
}

/// Where a foot is to be in a frame.
struct FootTarget {
    Vec3 ankle = Vec3(0);
    Quat turn = {1, 0, 0, 0};  ///< of the foot
    bool is_moved = false;     ///< or as in the clip
};

/// Follows the contacts of a foot through the frames.
class FootTracker {
  public:
    explicit FootTracker(float fade_frames) : fade_frames_(fade_frames) {}

    /// Call for each frame in order, with the positions of the clip and what touches the ground.
    FootTarget follow(const Vec3& ankle, const Vec3& toes, bool ankle_down, bool toes_down) {
        const Vec3 foot = toes - ankle;
        const bool keeps_ankle = ankle_down && ankle_was_down_;
        const bool keeps_toes = toes_down && toes_were_down_;
        if (keeps_ankle && keeps_toes) {
            turn_ = shortest_arc(
                normalize_or(foot, Vec3(0, 0, 1)),
                normalize_or(toe_pin_ - ankle_pin_, Vec3(0, 0, 1)));
            turn_at_end_ = turn_;
            frames_turning_ = 0;
        } else {
            turn_ = slerp(Quat(1, 0, 0, 0), turn_at_end_, remaining(++frames_turning_));
        }
        Vec3 at = ankle;
        if (keeps_ankle) {
            at = ankle_pin_;
        } else if (keeps_toes) {
            at = toe_pin_ - turn_ * foot;
        } else {
            at = ankle + remaining(++frames_free_) * shift_at_end_;
        }
        ankle_pin_ = keeps_ankle ? ankle_pin_ : at;
        toe_pin_ = keeps_toes ? toe_pin_ : at + turn_ * foot;
        ankle_was_down_ = ankle_down;
        toes_were_down_ = toes_down;
        if (ankle_down || toes_down) {
            shift_at_end_ = at - ankle;
            frames_free_ = 0;
        }
        const bool is_turned = std::abs(turn_.w) < 1.0f - 1e-7f;
        return {at, turn_, glm::distance(at, ankle) > 0 || is_turned};
    }

  private:
    /// Of a correction, some frames after its end.
    [[nodiscard]] float remaining(int frames) const {
        const float t = static_cast<float>(frames) / std::max(fade_frames_, 1e-3f);
        return t >= 1 ? 0.0f : 1 - t * t * (3 - 2 * t);
    }

    float fade_frames_;
    bool ankle_was_down_ = false;
    bool toes_were_down_ = false;
    Vec3 ankle_pin_ = Vec3(0);
    Vec3 toe_pin_ = Vec3(0);
    Vec3 shift_at_end_ = Vec3(0);
    Quat turn_ = {1, 0, 0, 0};
    Quat turn_at_end_ = {1, 0, 0, 0};
    int frames_free_ = 0;
    int frames_turning_ = 0;
};

struct PinnedLeg {
    PinnedLimb limb;
    std::optional<std::uint16_t> toes;
    std::vector<FootTarget> targets;  ///< one per frame
};

std::vector<bool> find_down(
    std::span<const ClipContact> contacts, std::optional<std::uint16_t> joint,
    const MotionFrames& frames) {
    std::vector<bool> down(frames.frames(), false);
    for (const ClipContact& contact : contacts) {
        if (!joint || contact.joint != *joint) {
            continue;
        }
        const auto begin = static_cast<std::size_t>(std::lround(contact.begin * frames.rate));
        const auto last = static_cast<std::size_t>(std::lround(contact.end * frames.rate));
        for (std::size_t f = begin; f <= std::min(last, frames.frames() - 1); ++f) {
            down[f] = true;
        }
    }
    return down;
}

void find_targets(
    const SkeletonData& skeleton, const MotionFrames& frames, std::span<const ClipContact> contacts,
    float fade, PinnedLeg& leg) {
    const std::vector<bool> ankle_down = find_down(contacts, leg.limb.tip, frames);
    const std::vector<bool> toes_down = find_down(contacts, leg.toes, frames);
    FootTracker tracker(fade * frames.rate);
    for (std::size_t f = 0; f < frames.frames(); ++f) {
        const std::vector<Affine> joints = find_frame_joints(skeleton, frames, f);
        const Vec3 ankle = position_in(joints, leg.limb.tip);
        const Vec3 toes = leg.toes ? position_in(joints, *leg.toes) : ankle + Vec3(0, 0, 1);
        leg.targets.push_back(tracker.follow(ankle, toes, ankle_down[f], toes_down[f]));
    }
}

/// How far the hip must go down for the leg to reach its target.
float find_drop(const std::vector<Affine>& joints, const PinnedLimb& leg, const Vec3& target) {
    const Vec3 hip = position_in(joints, leg.root);
    const Vec3 knee = position_in(joints, leg.middle);
    const Vec3 ankle = position_in(joints, leg.tip);
    const float length = kMaxReach * (glm::distance(hip, knee) + glm::distance(knee, ankle));
    const Vec3 to_hip = hip - target;
    const float across = to_hip.x * to_hip.x + to_hip.z * to_hip.z;
    return std::max(to_hip.y - std::sqrt(std::max(length * length - across, 0.0f)), 0.0f);
}

/// A smooth curve that is nowhere below `values`: their largest within `radius`, averaged.
std::vector<float> smooth_above(const std::vector<float>& values, std::size_t radius) {
    const auto near = [&](std::size_t i, const std::vector<float>& of) {
        const std::size_t first = i > radius ? i - radius : 0;
        return std::span(of).subspan(first, std::min(i + radius + 1, of.size()) - first);
    };
    std::vector<float> highest;
    for (std::size_t i = 0; i < values.size(); ++i) {
        highest.push_back(std::ranges::max(near(i, values)));
    }
    std::vector<float> smooth;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::span<const float> window = near(i, highest);
        float sum = 0;
        for (const float value : window) {
            sum += value;
        }
        smooth.push_back(sum / static_cast<float>(window.size()));
    }
    return smooth;
}

std::vector<PinnedLeg> list_legs(const BodyJoints& body) {
    std::vector<PinnedLeg> legs;
    for (const auto& [thigh, shin, foot, toes] :
         {std::array{
              BodyPart::LeftThigh, BodyPart::LeftShin, BodyPart::LeftFoot, BodyPart::LeftToes},
          std::array{
              BodyPart::RightThigh, BodyPart::RightShin, BodyPart::RightFoot,
              BodyPart::RightToes}}) {
        if (body.has(thigh) && body.has(shin) && body.has(foot)) {
            PinnedLeg& leg = legs.emplace_back();
            leg.limb = {body[thigh], body[shin], body[foot]};
            if (body.has(toes)) {
                leg.toes = body[toes];
            }
        }
    }
    return legs;
}

}  // namespace

void reach_with_limb(
    const SkeletonData& skeleton, MotionFrames& frames, std::size_t frame, const PinnedLimb& limb,
    const Vec3& target, const Vec3& hinge, const Quat& turn) {
    const std::vector<Affine> joints = find_frame_joints(skeleton, frames, frame);
    const std::span<Quat> local =
        std::span(frames.rotations).subspan(frame * frames.joints, frames.joints);
    const std::vector<Quat> rotations = find_frame_rotations(skeleton, local);
    const TwoLinkTurns turns = reach_with_two_links(
        position_in(joints, limb.root), position_in(joints, limb.middle),
        position_in(joints, limb.tip), target, hinge);
    const Quat lower = turns.root * turns.middle;
    const auto parent_rotation = [&](std::uint16_t joint) {
        const std::int32_t parent = skeleton.parents[joint];
        return parent < 0 ? Quat(1, 0, 0, 0) : rotations[static_cast<std::size_t>(parent)];
    };
    const auto set = [&](std::uint16_t joint, const Quat& parent, const Quat& rotation) {
        local[joint] =
            to_same_hemisphere(local[joint], glm::normalize(glm::conjugate(parent) * rotation));
    };
    set(limb.root, parent_rotation(limb.root), turns.root * rotations[limb.root]);
    set(limb.middle, turns.root * parent_rotation(limb.middle), lower * rotations[limb.middle]);
    set(limb.tip, lower * parent_rotation(limb.tip), turn * rotations[limb.tip]);
}

FootPins pin_feet(
    const SkeletonData& skeleton, const BodyJoints& body, MotionFrames& frames,
    std::span<const ClipContact> contacts, float fade) {
    std::vector<PinnedLeg> legs = list_legs(body);
    FootPins pins;
    for (PinnedLeg& leg : legs) {
        find_targets(skeleton, frames, contacts, fade, leg);
        pins.contacts += static_cast<std::size_t>(
            std::count_if(contacts.begin(), contacts.end(), [&](const ClipContact& contact) {
                return contact.joint == leg.limb.tip || (leg.toes && contact.joint == *leg.toes);
            }));
    }
    std::vector<float> drops(frames.frames(), 0.0f);
    for (std::size_t f = 0; f < frames.frames(); ++f) {
        const std::vector<Affine> joints = find_frame_joints(skeleton, frames, f);
        for (const PinnedLeg& leg : legs) {
            if (leg.targets[f].is_moved) {
                drops[f] = std::max(drops[f], find_drop(joints, leg.limb, leg.targets[f].ankle));
            }
        }
    }
    drops = smooth_above(drops, static_cast<std::size_t>(fade * frames.rate));
    const std::uint16_t root = find_body_root(skeleton, body);
    const Vec3 left = find_left(skeleton, body);
    const std::vector<Quat> rest = find_frame_rotations(skeleton, skeleton.rest.rotations);
    for (std::size_t f = 0; f < frames.frames(); ++f) {
        pins.lowered = std::max(pins.lowered, drops[f]);
        const std::vector<Quat> rotations = find_frame_rotations(
            skeleton, std::span(frames.rotations).subspan(f * frames.joints, frames.joints));
        if (drops[f] > 0) {
            move_joint(skeleton, frames, f, root, {0, -drops[f], 0});
        }
        for (const PinnedLeg& leg : legs) {
            const FootTarget& target = leg.targets[f];
            if (target.is_moved || drops[f] > 0) {
                const Vec3 hinge =
                    rotations[leg.limb.root] * glm::conjugate(rest[leg.limb.root]) * left;
                reach_with_limb(skeleton, frames, f, leg.limb, target.ankle, hinge, target.turn);
            }
        }
    }
    return pins;
}

}  // namespace limn
