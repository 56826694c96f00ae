#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/surface.h"

#include <span>
#include <string>
#include <vector>

namespace limn {

// Conservative bounds of a posed mesh, without visiting its vertices. With linear blending, a
// vertex is a weighted mean of its joints' transforms: it lies in the hull of the boxes that each
// joint has around the vertices it influences, transformed by the joint. With dual quaternions it
// may leave the straight line between two such positions, but not the sphere with this line as
// diameter; for more than two joints the largest such sphere is used, doubled. Morph targets widen
// every box by the maximum sum of their offsets. Never too small, and about as large as the boxes
// in rest pose.

struct SkinBounds {
    struct Joint {
        std::uint16_t joint = 0;  ///< index into SkinData::joints
        Bounds box;               ///< of the vertices it influences, in rest pose
    };
    struct Pair {
        std::uint16_t a = 0;
        std::uint16_t b = 0;
        Bounds box;  ///< of the vertices both influence
    };
    std::vector<Joint> joints;
    std::vector<Pair> pairs;
    Bounds still;                ///< of vertices without joints
    bool many = false;           ///< some vertex has more than two joints
    Bounds rest;                 ///< of all vertices
    std::vector<Bounds> morphs;  ///< of each target's offsets, including zero
};

/// The mesh's skin and morphs must be valid (check_deformable).
[[nodiscard]] SkinBounds make_skin_bounds(const MeshData& mesh);

/// `palette`: posed mesh from rest pose, one per joint of the skin; empty: morph targets only.
/// Matrices for dual quaternions have no scale. Missing weights are 0. `displacement`: upper bound
/// of how far deformers move a vertex [m]. The result is not finite if a joint that influences a
/// vertex is not.
[[nodiscard]] Bounds posed_bounds(
    const SkinBounds& bounds, std::span<const Affine> palette, Skinning skinning,
    std::span<const float> weights, float displacement = 0.0f);

/// Why the mesh cannot be deformed, to follow its name in a message; empty if it can.
[[nodiscard]] std::string check_deformable(const MeshData& mesh);

}  // namespace limn
