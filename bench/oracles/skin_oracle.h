#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/surface.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace limn::oracle {

// Skinning in double precision, one vertex after the other, as the textbook has it: offsets of
// morph targets, then the mean of the joints' 4x4 matrices with its inverse transpose for normals
// (char.skin-bone-offset), or the mean of their unit dual quaternions, turned into a matrix
// (Kavan 2008).

struct SkinnedVertex {
    glm::dvec3 position;
    glm::dvec3 normal;   ///< unit; not a number where the mean of the matrices has no inverse
    glm::dvec3 tangent;  ///< unit
};

/// Mesh from mesh at rest, a joint of the skin each. `joints`: character_from_joint.
[[nodiscard]] std::vector<glm::dmat4>
skin_matrices(const SkinData& skin, std::span<const Affine> joints);

/// `matrices` is empty where no joints move the mesh; missing weights are 0.
[[nodiscard]] std::vector<SkinnedVertex> skin_vertices(
    const MeshData& mesh, std::span<const glm::dmat4> matrices,
    std::span<const float> morph_weights, Skinning skinning);

}  // namespace limn::oracle
