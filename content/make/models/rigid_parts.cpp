#include "content/make/models/rigid_parts.h"

#include "content/bake/tangents.h"

#include <glm/gtc/quaternion.hpp>

#include <utility>

namespace limn {

void append_rigid(
    MeshData& mesh, const SkeletonData& skeleton, const MeshData& part, const RigidPart& at) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const Vec3 joint = rest_position(skeleton, at.joint);
    for (std::size_t v = 0; v < part.positions.size(); ++v) {
        const Vec4& tangent = part.tangents[v];
        mesh.positions.push_back(
            joint + at.position + at.rotation * (at.scale * part.positions[v]));
        mesh.normals.push_back(
            at.rotation * normalize_or(part.normals[v] / at.scale, part.normals[v]));
        mesh.tangents.emplace_back(
            at.rotation * normalize_or(at.scale * Vec3(tangent), Vec3(tangent)), tangent.w);
        mesh.uvs.push_back(part.uvs[v]);
        mesh.colors.emplace_back(at.color, 1.0f);
        mesh.skin.first.push_back(static_cast<std::uint32_t>(mesh.skin.joints.size()));
        mesh.skin.joints.push_back(at.joint);
        mesh.skin.weights.push_back(1.0f);
    }
    for (const std::uint32_t index : part.indices) {
        mesh.indices.push_back(first + index);
    }
}

void finish_rigid(MeshData& mesh) {
    mesh.skin.first.push_back(static_cast<std::uint32_t>(mesh.skin.joints.size()));
    update_bounds(mesh);
}

std::uint16_t
add_rigid_joint(SkeletonData& skeleton, std::string name, std::int32_t parent, const Vec3& offset) {
    skeleton.joints.push_back(std::move(name));
    skeleton.parents.push_back(parent);
    skeleton.rest.translations.push_back(offset);
    skeleton.rest.rotations.emplace_back(1, 0, 0, 0);
    skeleton.rest.scales.emplace_back(1, 1, 1);
    return static_cast<std::uint16_t>(skeleton.joints.size() - 1);
}

Vec3 rest_position(const SkeletonData& skeleton, std::int32_t joint) {
    Vec3 position(0);
    for (; joint >= 0; joint = skeleton.parents[joint]) {
        position += skeleton.rest.translations[joint];
    }
    return position;
}

SkinData make_rigid_skin(const SkeletonData& skeleton) {
    SkinData skin;
    for (std::size_t joint = 0; joint < skeleton.joints.size(); ++joint) {
        const Vec3 position = rest_position(skeleton, static_cast<std::int32_t>(joint));
        skin.joints.push_back(static_cast<std::uint16_t>(joint));
        skin.joint_from_mesh.push_back(affine_from(-position, Quat(1, 0, 0, 0), Vec3(1)));
    }
    return skin;
}

}  // namespace limn
