#include "bench/oracles/skin_oracle.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>

namespace limn::oracle {
namespace {

glm::dmat4 wide(const Affine& a) {
    glm::dmat4 m(1.0);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) {
            m[c][r] = a.row[r][c];
        }
    }
    return m;
}

struct Influence {
    std::size_t joint;
    double weight;
};

glm::dmat4 mean_matrix(std::span<const glm::dmat4> matrices, const std::vector<Influence>& by) {
    glm::dmat4 sum(0.0);
    for (const Influence& one : by) {
        sum += one.weight * matrices[one.joint];
    }
    return sum;
}

/// Gram-Schmidt orthonormalization that keeps the first column's direction.
glm::dmat3 without_scale(const glm::dmat3& m) {
    const glm::dvec3 x = glm::normalize(m[0]);
    const glm::dvec3 y = glm::normalize(m[1] - glm::dot(m[1], x) * x);
    return {x, y, glm::cross(x, y)};
}

glm::dmat4 mean_motion(std::span<const glm::dmat4> matrices, const std::vector<Influence>& by) {
    glm::dquat real(0, 0, 0, 0);
    glm::dquat dual(0, 0, 0, 0);
    glm::dquat first(1, 0, 0, 0);
    for (std::size_t i = 0; i < by.size(); ++i) {
        const glm::dmat4& m = matrices[by[i].joint];
        const glm::dquat turn = glm::quat_cast(without_scale(glm::dmat3(m)));
        const glm::dquat part = glm::dquat(0, glm::dvec3(m[3])) * turn * 0.5;
        first = i == 0 ? turn : first;
        const double weight = glm::dot(turn, first) < 0 ? -by[i].weight : by[i].weight;
        real += turn * weight;
        dual += part * weight;
    }
    const double size = glm::length(real);
    real /= size;
    dual /= size;
    const glm::dquat translation = dual * glm::conjugate(real) * 2.0;
    glm::dmat4 m = glm::mat4_cast(real);
    m[3] = glm::dvec4(translation.x, translation.y, translation.z, 1);
    return m;
}

}  // namespace

std::vector<glm::dmat4> skin_matrices(const SkinData& skin, std::span<const Affine> joints) {
    std::vector<glm::dmat4> matrices;
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
        matrices.push_back(wide(joints[skin.joints[i]]) * wide(skin.joint_from_mesh[i]));
    }
    return matrices;
}

std::vector<SkinnedVertex> skin_vertices(
    const MeshData& mesh, std::span<const glm::dmat4> matrices,
    std::span<const float> morph_weights, Skinning skinning) {
    std::vector<SkinnedVertex> vertices(mesh.positions.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        vertices[v] = {
            mesh.positions[v], mesh.normals.empty() ? Vec3(0, 0, 1) : mesh.normals[v],
            mesh.tangents.empty() ? Vec3(1, 0, 0) : Vec3(mesh.tangents[v])};
    }
    for (std::size_t t = 0; t < std::min(mesh.morphs.size(), morph_weights.size()); ++t) {
        const MorphTarget& target = mesh.morphs[t];
        const double weight = morph_weights[t];
        for (std::size_t i = 0; i < target.vertices.size(); ++i) {
            SkinnedVertex& moved = vertices[target.vertices[i]];
            moved.position += weight * glm::dvec3(target.positions[i]);
            moved.normal +=
                weight * glm::dvec3(target.normals.empty() ? Vec3(0) : target.normals[i]);
            moved.tangent +=
                weight * glm::dvec3(target.tangents.empty() ? Vec3(0) : target.tangents[i]);
        }
    }
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        SkinnedVertex& moved = vertices[v];
        std::vector<Influence> by;
        for (std::size_t i = mesh.skin.empty() ? 0 : mesh.skin.first[v];
             i < (mesh.skin.empty() ? 0 : mesh.skin.first[v + 1]); ++i) {
            by.push_back({mesh.skin.joints[i], mesh.skin.weights[i]});
        }
        if (!by.empty() && !matrices.empty()) {
            const glm::dmat4 m = skinning == Skinning::Linear ? mean_matrix(matrices, by)
                                                              : mean_motion(matrices, by);
            moved.position = glm::dvec3(m * glm::dvec4(moved.position, 1));
            moved.normal = glm::transpose(glm::inverse(glm::dmat3(m))) * moved.normal;
            moved.tangent = glm::dmat3(m) * moved.tangent;
        }
        moved.normal = glm::normalize(moved.normal);
        moved.tangent = glm::normalize(moved.tangent);
    }
    return vertices;
}

}  // namespace limn::oracle
