#include "systems/animation/ragdoll/ragdoll_rig.h"

#include "ecs/base/rotation.h"
#include "ecs/components/humanoid.h"
#include "systems/animation/ragdoll/closest_points.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

// Techniques: char.dynamics

namespace limn {
namespace {

constexpr float kMinHalfAngle = 0.05f;  // of a cone: a hinge has none [rad]

/// Joint matrices at rest, without scale, in the character's space.
struct RestPlaces {
    std::vector<Vec3> positions;
    std::vector<Quat> rotations;
    float size = 0;  ///< largest extent [m]
};

RestPlaces find_rest_places(const SkeletonData& skeleton) {
    const std::size_t count = skeleton.parents.size();
    RestPlaces places;
    Bounds bounds;
    std::vector<Affine> matrices(count);
    for (std::size_t j = 0; j < count; ++j) {
        const LocalPose& rest = skeleton.rest;
        const Quat local = normalize_or_identity(rest.rotations[j]);
        const std::int32_t parent = skeleton.parents[j];
        matrices[j] = affine_from(rest.translations[j], local, rest.scales[j]);
        places.rotations.push_back(local);
        if (parent >= 0) {
            matrices[j] = matrices[static_cast<std::size_t>(parent)] * matrices[j];
            places.rotations[j] = places.rotations[static_cast<std::size_t>(parent)] * local;
        }
        places.positions.push_back(transform_point(matrices[j], Vec3(0)));
        grow(bounds, places.positions.back());
    }
    if (count > 0) {
        const Vec3 extent = bounds.max - bounds.min;
        places.size = std::max({extent.x, extent.y, extent.z});
    }
    return places;
}

/// What a part of a person is like: its radius relative to the height, and its joint.
struct RagdollPart {
    BodyPart part;
    BodyPart tip;  ///< where the segment ends; the part itself: half as long as its parent
    float radius;
};
constexpr RagdollPart kRagdollParts[] = {
    {BodyPart::Hips, BodyPart::Hips, 0.075f},
    {BodyPart::Spine, BodyPart::Chest, 0.068f},
    {BodyPart::Chest, BodyPart::Neck, 0.08f},
    {BodyPart::Head, BodyPart::Head, 0.052f},
    {BodyPart::LeftUpperArm, BodyPart::LeftForearm, 0.027f},
    {BodyPart::LeftForearm, BodyPart::LeftHand, 0.023f},
    {BodyPart::LeftHand, BodyPart::LeftHand, 0.018f},
    {BodyPart::LeftThigh, BodyPart::LeftShin, 0.045f},
    {BodyPart::LeftShin, BodyPart::LeftFoot, 0.032f},
    {BodyPart::LeftFoot, BodyPart::LeftToes, 0.023f},
    {BodyPart::RightUpperArm, BodyPart::RightForearm, 0.027f},
    {BodyPart::RightForearm, BodyPart::RightHand, 0.023f},
    {BodyPart::RightHand, BodyPart::RightHand, 0.018f},
    {BodyPart::RightThigh, BodyPart::RightShin, 0.045f},
    {BodyPart::RightShin, BodyPart::RightFoot, 0.032f},
    {BodyPart::RightFoot, BodyPart::RightToes, 0.023f}};

/// A person's own axes, from the places of thighs and head.
struct BodyAxes {
    Vec3 left = {1, 0, 0};
    Vec3 up = {0, 1, 0};
    Vec3 forward = {0, 0, 1};
};

/// How far the joint of a part turns. Angles in degrees; directions in a person's axes, of the left
/// side: x out, y up, z forward.
struct RagdollPartLimit {
    BodyPart left;
    BodyPart right;
    bool hinge;
    Vec3 toward;  ///< middle of the cone; 0: the bone at rest. Of a hinge: where it bends to
    float min, max;
    float swing;
};
constexpr RagdollPartLimit kRagdollPartLimits[] = {
    {BodyPart::Spine, BodyPart::Spine, false, {0, 0, 0}, -20, 20, 24},
    {BodyPart::Chest, BodyPart::Chest, false, {0, 0, 0}, -20, 20, 24},
    {BodyPart::Head, BodyPart::Head, false, {0, 0, 0}, -45, 45, 38},
    {BodyPart::LeftUpperArm, BodyPart::RightUpperArm, false, {0.72f, -0.45f, 0.5f}, -60, 60, 80},
    {BodyPart::LeftForearm, BodyPart::RightForearm, true, {0, 0, 1}, 0, 145, 0},
    {BodyPart::LeftHand, BodyPart::RightHand, false, {0, 0, 0}, -15, 15, 50},
    {BodyPart::LeftThigh, BodyPart::RightThigh, false, {0.2f, -0.85f, 0.5f}, -30, 30, 55},
    {BodyPart::LeftShin, BodyPart::RightShin, true, {0, 0, -1}, 0, 145, 0},
    {BodyPart::LeftFoot, BodyPart::RightFoot, false, {0, 0, 0}, -10, 10, 28}};

class RigBuilder {
  public:
    explicit RigBuilder(const SkeletonData& skeleton)
        : skeleton_(skeleton), body_(find_body_joints(skeleton)),
          places_(find_rest_places(skeleton)), bone_of_(skeleton.parents.size(), -1) {}

    RagdollRig build() {
        if (!(places_.size > 0) || !std::isfinite(places_.size)) {
            return {};
        }
        using enum BodyPart;
        is_person_ = body_.has(Hips) && body_.has(LeftThigh) && body_.has(RightThigh)
                     && body_.has(LeftUpperArm) && body_.has(RightUpperArm) && body_.has(Head);
        find_axes();
        for (std::size_t j = 0; j < bone_of_.size(); ++j) {
            const std::int32_t parent = skeleton_.parents[j];
            bone_of_[j] = parent >= 0 ? bone_of_[static_cast<std::size_t>(parent)] : -1;
            if (rig_.bones.size() < kMaxRagdollBones) {
                add_bone(static_cast<std::uint16_t>(j));
            }
        }
        share_mass();
        find_apart();
        return std::move(rig_);
    }

  private:
    void find_axes() {
        if (!is_person_) {
            return;
        }
        const auto at = [&](BodyPart part) { return places_.positions[body_[part]]; };
        axes_.left =
            normalize_or(at(BodyPart::LeftThigh) - at(BodyPart::RightThigh), Vec3(1, 0, 0));
        const Vec3 up = at(BodyPart::Head) - at(BodyPart::Hips);
        axes_.up = normalize_or(up - glm::dot(up, axes_.left) * axes_.left, Vec3(0, 1, 0));
        axes_.forward = glm::cross(axes_.left, axes_.up);
    }

    /// The capsule of a joint in the character's space; none if it goes with its parent.
    struct Capsule {
        Vec3 from;
        Vec3 to;
        float radius;
    };
    [[nodiscard]] std::optional<Capsule> find_capsule(std::uint16_t joint) const {
        if (!is_person_) {
            return find_plain_capsule(joint);
        }
        const auto* const shape = std::ranges::find_if(
            kRagdollParts, [&](const RagdollPart& one) { return body_[one.part] == joint; });
        if (shape == std::end(kRagdollParts)) {
            return std::nullopt;
        }
        const float radius = shape->radius * places_.size;
        const Vec3 from = places_.positions[joint];
        if (shape->part == BodyPart::Hips) {  // across, from thigh to thigh
            return Capsule{
                places_.positions[body_[BodyPart::RightThigh]],
                places_.positions[body_[BodyPart::LeftThigh]], radius};
        }
        if (shape->tip != shape->part && body_.has(shape->tip)) {
            const Vec3 to = places_.positions[body_[shape->tip]];
            return Capsule{from, to, radius};
        }
        const Vec3 along = shape->part == BodyPart::Head ? axes_.up : direction_from_parent(joint);
        const bool is_foot =
            shape->part == BodyPart::LeftFoot || shape->part == BodyPart::RightFoot;
        const Vec3 direction = is_foot ? axes_.forward : along;
        return Capsule{from, from + 0.07f * places_.size * direction, radius};
    }

    /// From a joint to the middle of its children; where there are none, on along its parent.
    [[nodiscard]] std::optional<Capsule> find_plain_capsule(std::uint16_t joint) const {
        const Vec3 from = places_.positions[joint];
        Vec3 sum(0);
        float children = 0;
        for (std::size_t j = joint + 1u; j < skeleton_.parents.size(); ++j) {
            if (skeleton_.parents[j] == joint
                && glm::distance(places_.positions[j], from) > 0.02f * places_.size) {
                sum += places_.positions[j];
                ++children;
            }
        }
        Vec3 to = from;
        if (children > 0) {
            to = sum / children;
        } else if (const std::int32_t parent = skeleton_.parents[joint]; parent >= 0) {
            to += 0.6f * (from - places_.positions[static_cast<std::size_t>(parent)]);
        }
        const float length = glm::distance(from, to);
        if (!(length > 0.02f * places_.size)) {
            return std::nullopt;
        }
        const float radius = std::clamp(0.25f * length, 0.01f * places_.size, 0.06f * places_.size);
        return Capsule{from, to, radius};
    }

    [[nodiscard]] Vec3 direction_from_parent(std::uint16_t joint) const {
        const std::int32_t parent = skeleton_.parents[joint];
        return parent < 0 ? axes_.up
                          : normalize_or(
                              places_.positions[joint]
                                  - places_.positions[static_cast<std::size_t>(parent)],
                              axes_.up);
    }

    void add_bone(std::uint16_t joint) {
        const std::optional<Capsule> capsule = find_capsule(joint);
        const bool is_second_root = bone_of_[joint] < 0 && !rig_.bones.empty();
        if (!capsule || is_second_root) {
            return;
        }
        RagdollBone bone;
        bone.joint = joint;
        bone.parent = bone_of_[joint];
        const Quat back = glm::conjugate(places_.rotations[joint]);
        const Vec3 origin = places_.positions[joint];
        bone.from = back * (capsule->from - origin);
        bone.to = back * (capsule->to - origin);
        bone.radius = capsule->radius;
        bone.rest = places_.rotations[joint];
        if (bone.parent >= 0) {
            const std::uint16_t parent = rig_.bones[static_cast<std::size_t>(bone.parent)].joint;
            const Quat from_world = glm::conjugate(places_.rotations[parent]);
            bone.anchor = from_world * (origin - places_.positions[parent]);
            bone.rest = glm::normalize(from_world * places_.rotations[joint]);
        }
        bone.limit = find_limit(bone);
        bone_of_[joint] = static_cast<std::int32_t>(rig_.bones.size());
        rig_.bones.push_back(bone);
    }

    [[nodiscard]] RagdollLimit find_limit(const RagdollBone& bone) const {
        RagdollLimit limit;
        limit.bone = normalize_or(bone.to - bone.from, Vec3(0, 1, 0));
        limit.center = limit.bone;
        limit.axis = any_perpendicular(limit.bone);
        std::vector<JointFreedom> freedoms;
        for (const JointFreedom& freedom : skeleton_.freedoms) {
            if (freedom.joint == bone.joint) {
                freedoms.push_back(freedom);
            }
        }
        if (!freedoms.empty()) {
            use_freedoms(freedoms, limit);
        } else if (is_person_) {
            use_part(bone, limit);
        }
        return limit;
    }

    /// One axis: a hinge. More: the one most along the bone is its twist, the others are the axes
    /// of the ellipse.
    static void use_freedoms(std::vector<JointFreedom> freedoms, RagdollLimit& limit) {
        for (JointFreedom& freedom : freedoms) {
            freedom.axis = normalize_or(freedom.axis, Vec3(1, 0, 0));
            const float low = finite_or(freedom.min, -kPi);
            const float high = finite_or(freedom.max, kPi);
            freedom.min = std::clamp(std::min(low, high), -kPi, kPi);
            freedom.max = std::clamp(std::max(low, high), -kPi, kPi);
        }
        if (freedoms.size() == 1) {
            limit.kind = RagdollJointKind::Hinge;
            limit.axis = freedoms[0].axis;
            limit.min = freedoms[0].min;
            limit.max = freedoms[0].max;
            return;
        }
        const auto twist = std::ranges::max_element(freedoms, {}, [&](const JointFreedom& one) {
            return std::abs(glm::dot(one.axis, limit.bone));
        });
        limit.min = 0;
        limit.max = 0;
        if (std::abs(glm::dot(twist->axis, limit.bone)) > 0.7f) {
            const float sign = std::copysign(1.0f, glm::dot(twist->axis, limit.bone));
            limit.min = std::min(sign * twist->min, sign * twist->max);
            limit.max = std::max(sign * twist->min, sign * twist->max);
            freedoms.erase(twist);
        }
        Quat center(1, 0, 0, 0);
        float half[2] = {kMinHalfAngle, kMinHalfAngle};
        for (std::size_t i = 0; i < std::min<std::size_t>(freedoms.size(), 2); ++i) {
            const JointFreedom& one = freedoms[i];
            center = center * rotation_about(one.axis, 0.5f * (one.min + one.max));
            half[i] = std::clamp(0.5f * (one.max - one.min), kMinHalfAngle, kPi);
        }
        limit.center = center * limit.bone;
        limit.swing = half[0];
        limit.sway = half[1];
        const Vec3& first = freedoms[0].axis;
        limit.axis = normalize_or(
            first - glm::dot(first, limit.center) * limit.center, any_perpendicular(limit.center));
    }

    void use_part(const RagdollBone& bone, RagdollLimit& limit) const {
        const auto* const part =
            std::ranges::find_if(kRagdollPartLimits, [&](const RagdollPartLimit& one) {
                return body_[one.left] == bone.joint || body_[one.right] == bone.joint;
            });
        if (part == std::end(kRagdollPartLimits)) {
            return;
        }
        const bool is_right = part->left != part->right && body_[part->right] == bone.joint;
        const Vec3 out = is_right ? -axes_.left : axes_.left;
        const Quat back = glm::conjugate(places_.rotations[bone.joint]);
        const Vec3 toward =
            back
            * (part->toward.x * out + part->toward.y * axes_.up + part->toward.z * axes_.forward);
        limit.min = radians(part->min);
        limit.max = radians(part->max);
        if (part->hinge) {
            limit.kind = RagdollJointKind::Hinge;
            limit.axis =
                normalize_or(glm::cross(limit.bone, toward), any_perpendicular(limit.bone));
            return;
        }
        limit.swing = limit.sway = radians(part->swing);
        limit.center = normalize_or(toward, limit.bone);
        limit.axis = any_perpendicular(limit.center);
    }

    void share_mass() {
        double sum = 0;
        for (RagdollBone& bone : rig_.bones) {
            const double volume = find_capsule_mass(
                                      static_cast<double>(glm::distance(bone.from, bone.to)),
                                      static_cast<double>(bone.radius))
                                      .volume;
            bone.share = static_cast<float>(volume);
            sum += volume;
        }
        for (RagdollBone& bone : rig_.bones) {
            bone.share = static_cast<float>(static_cast<double>(bone.share) / sum);
        }
    }

    /// Bones that do not touch at rest, are not of one joint, and have no common parent.
    void find_apart() {
        const std::size_t count = rig_.bones.size();
        rig_.apart.assign(count, 0);
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                const RagdollBone& a = rig_.bones[i];
                const RagdollBone& b = rig_.bones[j];
                const bool are_joined = a.parent == static_cast<std::int32_t>(j);
                if (!are_joined && gap(a, b) > 0) {
                    rig_.apart[i] |= std::uint64_t{1} << j;
                    rig_.apart[j] |= std::uint64_t{1} << i;
                }
            }
        }
    }
    [[nodiscard]] double gap(const RagdollBone& a, const RagdollBone& b) const {
        const auto ends = [&](const RagdollBone& bone) {
            const Quat& turn = places_.rotations[bone.joint];
            const Vec3& at = places_.positions[bone.joint];
            return LineSegment{RigidVec(at + turn * bone.from), RigidVec(at + turn * bone.to)};
        };
        const ClosestPair pair = closest_points(ends(a), ends(b));
        return glm::distance(pair.on_a, pair.on_b) - 1.1 * static_cast<double>(a.radius + b.radius);
    }

    const SkeletonData& skeleton_;
    BodyJoints body_;
    RestPlaces places_;
    std::vector<std::int32_t> bone_of_;  ///< of each joint; -1: none yet
    bool is_person_ = false;
    BodyAxes axes_;
    RagdollRig rig_;
};

}  // namespace

RagdollRig make_ragdoll_rig(const SkeletonData& skeleton) {
    return RigBuilder(skeleton).build();
}

CapsuleMass find_capsule_mass(double length, double radius) {
    constexpr double kPiDouble = 3.14159265358979323846;
    const double area = kPiDouble * radius * radius;
    const double tube = area * length;
    const double ball = area * radius * 4 / 3;
    const double volume = tube + ball;
    // Cylinder and two hemispheres, whose centers are 3/8 r beyond the ends.
    const double r2 = radius * radius;
    const double along = tube * r2 / 2 + ball * r2 * 2 / 5;
    const double across = tube * (length * length / 12 + r2 / 4)
                          + ball * (r2 * 2 / 5 + length * length / 4 + length * radius * 3 / 8);
    return {volume, along / volume, across / volume};
}

}  // namespace limn
