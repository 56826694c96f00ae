#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/surface.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace limn::oracle {

// Textbook skinning in double precision, vertex by vertex: offsets of morph targets, then the mean
// of the joints' 4x4 matrices with its inverse transpose for normals (char.skin-bone-offset), or
// the mean of their unit dual quaternions, turned into a matrix (Kavan 2008).

struct SkinnedVertex {
    glm::dvec3 position;
    glm::dvec3 normal;   ///< unit; NaN if the mean matrix is singular
    glm::dvec3 tangent;  ///< unit
};

/// Matrices from the mesh at rest to the posed mesh, one per joint of the skin. `joints`:
/// character_from_joint.
[[nodiscard]] std::vector<glm::dmat4>
skin_matrices(const SkinData& skin, std::span<const Affine> joints);

/// `matrices` is empty for a mesh without joints; missing weights are 0.
[[nodiscard]] std::vector<SkinnedVertex> skin_vertices(
    const MeshData& mesh, std::span<const glm::dmat4> matrices,
    std::span<const float> morph_weights, Skinning skinning);

}  // namespace limn::oracle
