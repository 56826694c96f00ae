#include "content/make/person/person_bends.h"

#include "content/make/person/person_skeleton.h"
#include "ecs/base/rotation.h"
#include "ecs/components/bend_shapes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

// Techniques: char.skin-defects

namespace limn {

namespace {

constexpr float kMinShift = 1e-4f;  ///< of a vertex that a shape moves [m]
constexpr float kMaxShift = 0.12f;  ///< far from a hip, skin is held by what is around it [m]

struct BendHinge {
    std::uint16_t joint = 0;
    Vec3 center = {};
    Vec3 axis = {};    ///< bends by positive angles
    Vec3 inward = {};  ///< from the joint to the inside of the bend
};

Vec3 rest_center(const SkeletonData& skeleton, std::int32_t joint) {
    Vec3 p(0);
    for (; joint >= 0; joint = skeleton.parents[static_cast<std::size_t>(joint)]) {
        p += skeleton.rest.translations[static_cast<std::size_t>(joint)];
    }
    return p;
}

BendHinge find_hinge(const SkeletonData& skeleton, std::uint16_t joint, std::uint16_t end) {
    BendHinge hinge = {.joint = joint, .center = rest_center(skeleton, joint)};
    for (const JointFreedom& freedom : skeleton.freedoms) {
        if (freedom.joint == joint) {
            hinge.axis = freedom.max >= -freedom.min ? freedom.axis : -freedom.axis;
            break;
        }
    }
    hinge.inward = glm::normalize(glm::cross(hinge.axis, skeleton.rest.translations[end]));
    return hinge;
}

/// Which joints move with `joint`: itself and all below.
std::vector<bool> list_carried(const SkeletonData& skeleton, std::uint16_t joint) {
    std::vector<bool> carried(skeleton.joints.size(), false);
    carried[joint] = true;
    for (std::size_t i = joint + 1u; i < carried.size(); ++i) {
        carried[i] =
            skeleton.parents[i] >= 0 && carried[static_cast<std::size_t>(skeleton.parents[i])];
    }
    return carried;
}

/// How far `p` has to be moved at rest to be where it belongs when the hinge is bent by kFullBend
/// and carries it by `share`.
Vec3 bend_shift(const BendHinge& hinge, const Vec3& p, float share) {
    const Vec3 from = p - hinge.center;
    const Quat whole = rotation_about(hinge.axis, kFullBend);
    const Mat3 blend = (1 - share) * Mat3(1) + share * glm::mat3_cast(whole);
    const Vec3 wanted = rotation_about(hinge.axis, share * kFullBend) * from;
    const float across = glm::length(from - glm::dot(from, hinge.axis) * hinge.axis);
    const float inside = glm::dot(from, hinge.inward) / std::max(across, 1e-4f);
    const float outside = 1 - glm::smoothstep(-0.2f, 0.7f, inside);
    const Vec3 shift = outside * (glm::inverse(blend) * (wanted - blend * from));
    const float length = glm::length(shift);
    return length > 0 ? kMaxShift * std::tanh(length / kMaxShift) / length * shift : shift;
}

MorphTarget
make_bend_shape(const MeshData& mesh, const SkeletonData& skeleton, const BendHinge& hinge) {
    MorphTarget shape;
    shape.name = std::string(kBendShapePrefix) + skeleton.joints[hinge.joint];
    const std::vector<bool> carried = list_carried(skeleton, hinge.joint);
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        float share = 0;
        for (std::uint32_t i = mesh.skin.first[v]; i < mesh.skin.first[v + 1]; ++i) {
            share += carried[mesh.skin.joints[i]] ? mesh.skin.weights[i] : 0.0f;
        }
        const Vec3 shift = bend_shift(hinge, mesh.positions[v], share);
        if (glm::length(shift) > kMinShift) {
            shape.vertices.push_back(v);
            shape.positions.push_back(shift);
        }
    }
    return shape;
}

}  // namespace

void add_bend_shapes(MeshData& mesh, const SkeletonData& skeleton) {
    constexpr std::array<std::pair<SideJoint, SideJoint>, 3> kBones = {{
        {SideJoint::Forearm, SideJoint::Hand},
        {SideJoint::Shin, SideJoint::Foot},
        {SideJoint::Thigh, SideJoint::Shin},
    }};
    for (const auto& [joint, end] : kBones) {
        for (const int side : {1, -1}) {
            mesh.morphs.push_back(make_bend_shape(
                mesh, skeleton,
                find_hinge(skeleton, joint_index(joint, side), joint_index(end, side))));
        }
    }
}

}  // namespace limn
