#pragma once

#include "ecs/base/rng.h"
#include "ecs/components/skeleton.h"
#include "ecs/components/surface.h"

#include <vector>

namespace limn::oracle {

// Random meshes and joints, to test skinning with.

/// A tube of radius 0.2 about +y from 0 to `height`, open at both ends.
[[nodiscard]] MeshData make_tube(int rings, int sectors, float height);

/// Each vertex gets up to `max_influences` joints near its height, of `joints` spread over the
/// mesh's height.
void add_weights(MeshData& mesh, int joints, int max_influences, Random& random);

/// Random offsets of every `step`-th vertex, different for each target.
void add_morphs(MeshData& mesh, int targets, std::uint32_t step, float size, Random& random);

/// A chain of joints `spacing` apart along +y, in bind pose.
[[nodiscard]] SkinData make_chain(int joints, float spacing);

/// Every joint is rotated, moved and, if `scaled`, stretched a little relative to its parent.
[[nodiscard]] std::vector<Affine>
random_joints(int joints, float spacing, float max_angle, bool scaled, Random& random);

}  // namespace limn::oracle
