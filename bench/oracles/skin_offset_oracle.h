#pragma once

#include "ecs/components/surface.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <span>

namespace limn::oracle {

// Skinning in double precision by vertex offsets (char.skin-vertex-offset): every vertex is stored
// in the space of each of its joints, and the joints transform the offsets directly, without a
// matrix palette.

/// Converts to double precision.
[[nodiscard]] inline glm::dmat4 double_matrix(const Affine& a) {
    glm::dmat4 m(1.0);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            m[column][row] = static_cast<double>(a.row[row][column]);
        }
    }
    return m;
}

/// Skinned position of vertex `v`: the weighted mean of its offsets transformed by the joints.
[[nodiscard]] inline glm::dvec3 skin_by_offsets(
    const MeshData& mesh, const SkinData& skin, std::span<const Affine> joints, std::size_t v) {
    glm::dvec3 sum(0);
    for (std::size_t i = mesh.skin.first[v]; i < mesh.skin.first[v + 1]; ++i) {
        const std::uint16_t joint = mesh.skin.joints[i];
        const glm::dvec4 offset = double_matrix(skin.joint_from_mesh[joint])
                                  * glm::dvec4(glm::dvec3(mesh.positions[v]), 1);
        sum += static_cast<double>(mesh.skin.weights[i])
               * glm::dvec3(double_matrix(joints[skin.joints[joint]]) * offset);
    }
    return sum;
}

/// Transforms `p` by the blend of two screw motions, by definition: rotate by the mean of the
/// quaternions (in the same hemisphere) and add the blended translation.
[[nodiscard]] inline glm::dvec3
move_by_screws(const glm::dmat4& a, const glm::dmat4& b, double weight_b, const glm::dvec3& p) {
    const glm::dquat qa = glm::quat_cast(glm::dmat3(a));
    glm::dquat qb = glm::quat_cast(glm::dmat3(b));
    const glm::dquat dual_a = glm::dquat(0, glm::dvec3(a[3])) * qa;
    glm::dquat dual_b = glm::dquat(0, glm::dvec3(b[3])) * qb;
    if (glm::dot(qa, qb) < 0) {
        qb = -qb;
        dual_b = -dual_b;
    }
    const glm::dquat q = qa * (1 - weight_b) + qb * weight_b;
    const glm::dquat dual = dual_a * (1 - weight_b) + dual_b * weight_b;
    const double length = glm::length(q);
    const glm::dquat unit = q / length;
    const glm::dquat shift = (dual / length) * glm::conjugate(unit);
    const glm::dquat turned = unit * glm::dquat(0, p) * glm::conjugate(unit);
    return glm::dvec3(turned.x, turned.y, turned.z) + glm::dvec3(shift.x, shift.y, shift.z);
}

}  // namespace limn::oracle
