#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/surface.h"

#include <span>
#include <string>
#include <vector>

namespace limn {

// Where a mesh can be when joints move it, without a look at its vertices. Blended linearly, a
// vertex is a mean of where its joints would take it: it lies in the hull of the boxes that each
// joint has around the vertices it moves, where the joint takes them. Blended as dual quaternions
// it may leave the straight line between two such places, but not the ball that has this line as
// its diameter; of more than two joints the widest such ball is taken, twice. Morph targets widen
// every box by the most that their offsets can add up to. Never too small, and about as large as
// the boxes at rest.

struct SkinBounds {
    struct Joint {
        std::uint16_t joint = 0;  ///< place in SkinData::joints
        Bounds box;               ///< of the vertices that it moves, at rest
    };
    struct Pair {
        std::uint16_t a = 0;
        std::uint16_t b = 0;
        Bounds box;  ///< of the vertices that both move
    };
    std::vector<Joint> joints;
    std::vector<Pair> pairs;
    Bounds still;                ///< of vertices without joints
    bool many = false;           ///< some vertex has more than two joints
    Bounds rest;                 ///< of all
    std::vector<Bounds> morphs;  ///< of each target's offsets, with zero
};

/// The mesh's skin and morphs must be whole (check_deformable).
[[nodiscard]] SkinBounds make_skin_bounds(const MeshData& mesh);

/// `palette`: mesh now from mesh at rest, one a joint of the skin; empty: morph targets alone.
/// Matrices of dual quaternions have no scale. Missing weights are 0. Not finite where a joint that
/// moves a vertex is not.
[[nodiscard]] Bounds posed_bounds(
    const SkinBounds& bounds, std::span<const Affine> palette, Skinning skinning,
    std::span<const float> weights);

/// What keeps the mesh from being deformed, as part of a sentence; empty if nothing does.
[[nodiscard]] std::string check_deformable(const MeshData& mesh);

}  // namespace limn
