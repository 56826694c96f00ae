#include "content/make/person/person_growth.h"

#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace limn {

namespace {

/// Scale by `across` and, in the direction of `along`, by `length`.
Mat3 bone_scale(float across, float length, const Vec3& along) {
    return Mat3(across) + (length - across) * glm::outerProduct(along, along);
}

Mat3 axis_scale(const Vec3& axes) {
    return {{axes.x, 0, 0}, {0, axes.y, 0}, {0, 0, axes.z}};
}

/// Of the bones of a child of four, relative to those of an adult of the same size.
Mat3 infant_scale(const PersonFrame& frame, std::size_t joint) {
    const PersonJointPlace place = person_joint_place(joint);
    if (place.side == 0) {
        switch (static_cast<PersonJoint>(place.own)) {
        case PersonJoint::Hips:
            return axis_scale({0.92f, 0.95f, 0.98f});
        case PersonJoint::Spine:
        case PersonJoint::Chest:
        case PersonJoint::UpperChest:
            return axis_scale({0.88f, 0.95f, 0.95f});
        case PersonJoint::Neck:
            return axis_scale({0.80f, 0.70f, 0.84f});
        default:
            return Mat3(1.44f);
        }
    }
    switch (static_cast<SideJoint>(place.own)) {
    case SideJoint::Shoulder:
        return axis_scale({0.80f, 0.90f, 0.92f});
    case SideJoint::UpperArm:
    case SideJoint::UpperArmTwist:
    case SideJoint::Forearm:
    case SideJoint::ForearmTwist: {
        Vec3 along = frame.forearm.along;
        along.x *= static_cast<float>(place.side);
        return bone_scale(0.92f, 0.88f, along);
    }
    case SideJoint::Thigh:
    case SideJoint::ThighTwist:
    case SideJoint::Shin:
        return axis_scale({0.95f, 0.80f, 0.95f});
    default:  // hands and feet
        return Mat3(0.88f);
    }
}

using BoneScales = std::array<Mat3, kPersonJoints>;

BoneScales bone_scales(const PersonFrame& frame) {
    BoneScales scales;
    for (std::size_t j = 0; j < kPersonJoints; ++j) {
        scales[j] = Mat3(1) + frame.infant * (infant_scale(frame, j) - Mat3(1));
    }
    return scales;
}

}  // namespace

PersonFrame grown_frame(const PersonFrame& frame) {
    PersonFrame own = frame;
    if (frame.infant == 0) {
        return own;
    }
    const BoneScales scales = bone_scales(frame);
    for (std::size_t j = 1; j < kPersonJoints; ++j) {
        const auto parent = static_cast<std::size_t>(person_joint_parent(j));
        own.joints[j] =
            own.joints[parent] + scales[parent] * (frame.joints[j] - frame.joints[parent]);
    }
    const std::size_t foot = joint_index(SideJoint::Foot, 1);
    const std::size_t head = joint_index(PersonJoint::Head);
    const float lift = (scales[foot] * frame.joints[foot]).y - own.joints[foot].y;
    for (Vec3& joint : own.joints) {
        joint.y += lift;
    }
    const float height =
        own.joints[head].y + (scales[head] * Vec3(0, kReferenceHeight - frame.joints[head].y, 0)).y;
    own.scale = frame.scale * kReferenceHeight / height;
    own.head_origin = own.joints[head] + scales[head] * (frame.head_origin - frame.joints[head]);
    own.head_scale = frame.head_scale * scales[head][0][0];
    return own;
}

void grow_mesh(MeshData& mesh, const PersonFrame& frame, const PersonFrame& own) {
    BoneScales scales;
    scales.fill(Mat3(1));
    if (frame.infant > 0) {
        scales = bone_scales(frame);
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            Vec3 moved(0);
            Mat3 stretch(0);
            for (std::uint32_t i = mesh.skin.first[v]; i < mesh.skin.first[v + 1]; ++i) {
                const std::size_t j = mesh.skin.joints[i];
                const float weight = mesh.skin.weights[i];
                stretch += weight * scales[j];
                moved +=
                    weight * (own.joints[j] + scales[j] * (mesh.positions[v] - frame.joints[j]));
            }
            mesh.positions[v] = moved;
            mesh.normals[v] = normalize_or(
                glm::transpose(glm::inverse(stretch)) * mesh.normals[v], mesh.normals[v]);
            const Vec3 tangent = stretch * Vec3(mesh.tangents[v]);
            const Vec3& n = mesh.normals[v];
            mesh.tangents[v] = Vec4(
                normalize_or(tangent - glm::dot(tangent, n) * n, Vec3(mesh.tangents[v])),
                mesh.tangents[v].w);
        }
    }
    for (Vec3& p : mesh.positions) {
        p *= own.scale;
    }
    const float face = own.scale * scales[joint_index(PersonJoint::Head)][0][0];
    for (MorphTarget& target : mesh.morphs) {
        for (Vec3& shift : target.positions) {
            shift *= face;
        }
    }
}

}  // namespace limn
