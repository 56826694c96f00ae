#include "ecs/components/body_map.h"

#include "ecs/base/limb_reach.h"
#include "ecs/base/rotation.h"
#include "ecs/components/body_measures.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.retarget-body

namespace limn {
namespace {

constexpr float kSameFacing = radians(10.0f);  ///< bodies that face less apart face the same way
constexpr float kFloorBand = 0.12f;            ///< feet this low stand on y = 0 [leg lengths]

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

    std::vector<FollowedJoint> match() {
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
            found_.begin(), found_.end(), [](const FollowedJoint& f) { return f.first >= 0; });
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
    std::vector<FollowedJoint> found_;
};

/// Rotation about the vertical by which the target faces as the source does.
Quat find_facing(const BodySize& source, const BodySize& target) {
    const Vec3 from = find_left(target.skeleton, target.joints);
    const Vec3 to = find_left(source.skeleton, source.joints);
    const float angle = std::atan2(glm::cross(from, to).y, glm::dot(from, to));
    return std::abs(angle) < kSameFacing ? Quat(1, 0, 0, 0) : rotation_about({0, 1, 0}, angle);
}

/// For each joint of the target: turns its rest pose, limb by limb, into that of the source.
std::vector<Quat>
find_alignments(const BodySize& source, const BodySize& target, const Quat& facing) {
    std::vector<Quat> alignments(target.rest.size(), facing);
    std::vector<bool> is_limb(target.rest.size(), false);
    const auto align = [&](BodyPart part, BodyPart next) {
        const bool has = source.joints.has(part) && source.joints.has(next)
                         && target.joints.has(part) && target.joints.has(next);
        if (!has) {
            return;
        }
        const auto along = [&](const BodySize& body) {
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

}  // namespace

std::vector<FollowedJoint>
match_body_joints(const SkeletonData& source, const SkeletonData& target) {
    return JointMatcher(source, target).match();
}

BodySize::BodySize(const SkeletonData& of)
    : skeleton(of), joints(find_body_joints(of)), rest(find_rest_matrices(of)),
      rest_rotations(find_frame_rotations(of, of.rest.rotations)), root(find_body_root(of, joints)),
      leg(find_leg_length(of, joints)) {
    if (leg > 0) {
        measure_feet();
    }
}

float BodySize::find_lowest(std::span<const Affine> matrices) const {
    float lowest = INFINITY;
    for (std::size_t j = 0; j < matrices.size(); ++j) {
        if (is_foot[j]) {
            lowest = std::min(lowest, transform_point(matrices[j], Vec3(0)).y);
        }
    }
    return lowest;
}

Vec3 BodySize::middle(std::span<const Affine> matrices) const {
    if (!joints.has(BodyPart::LeftThigh) || !joints.has(BodyPart::RightThigh)) {
        return transform_point(matrices[root], Vec3(0));
    }
    return 0.5f
           * (transform_point(matrices[joints[BodyPart::LeftThigh]], Vec3(0))
              + transform_point(matrices[joints[BodyPart::RightThigh]], Vec3(0)));
}

void BodySize::measure_feet() {
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

std::size_t BodyMap::count() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(followed, [](const FollowedJoint& f) { return f.first >= 0; }));
}

BodyMap make_body_map(const BodySize& source, const BodySize& target) {
    BodyMap map;
    map.followed = match_body_joints(source.skeleton, target.skeleton);
    map.alignments = find_alignments(source, target, find_facing(source, target));
    map.source_rest = source.rest_rotations;
    map.target_rest = target.rest_rotations;
    map.scale = source.leg > 0 && target.leg > 0 ? target.leg / source.leg : 1.0f;
    return map;
}

Vec3 find_body_shift(const BodySize& source, const BodySize& target, float scale, float ground) {
    if (source.leg <= 0 || target.leg <= 0) {
        return target.rest_position(target.root) - scale * source.rest_position(source.root);
    }
    const float raised = target.stands_on_zero ? -scale * ground : 0.0f;
    return {0, raised + target.ankle - scale * source.ankle, 0};
}

void map_body_turns(
    const BodyMap& map, const SkeletonData& target, std::span<const Quat> turns,
    std::vector<Quat>& outer, std::span<Quat> local) {
    const auto turned = [&](std::int32_t j) {
        const auto i = static_cast<std::size_t>(j);
        return turns[i] * glm::conjugate(map.source_rest[i]);
    };
    outer.resize(local.size());
    for (std::size_t j = 0; j < local.size(); ++j) {
        const std::int32_t parent = target.parents[j];
        const Quat above = parent < 0 ? Quat(1, 0, 0, 0) : outer[static_cast<std::size_t>(parent)];
        const FollowedJoint& follows = map.followed[j];
        if (follows.first >= 0) {
            const Quat turn = slerp(turned(follows.first), turned(follows.second), follows.u);
            const Quat made = glm::normalize(
                glm::conjugate(above) * turn * map.alignments[j] * map.target_rest[j]);
            local[j] = to_same_hemisphere(local[j], made);
        }
        outer[j] = above * local[j];
    }
}

}  // namespace limn
