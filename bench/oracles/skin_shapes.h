#pragma once

#include "ecs/base/rng.h"
#include "ecs/components/skeleton.h"
#include "ecs/components/surface.h"

#include <vector>

namespace limn::oracle {

// Meshes and joints made by chance, to hold skinning against its oracle.

/// A tube of radius 0.2 about +y from 0 to `height`, open at both ends.
[[nodiscard]] MeshData make_tube(int rings, int sectors, float height);

/// Each vertex follows `most` joints or fewer that are near its height, of `joints` spread over it.
void add_weights(MeshData& mesh, int joints, int most, Random& random);

/// Offsets at every `step`-th vertex, other ones for each target.
void add_morphs(MeshData& mesh, int targets, std::uint32_t step, float size, Random& random);

/// Joints `spacing` apart along +y, as they are when the mesh is bound to them.
[[nodiscard]] SkinData make_chain(int joints, float spacing);

/// Every joint turned, moved and, if `scaled`, stretched a little relative to the one below.
[[nodiscard]] std::vector<Affine>
random_joints(int joints, float spacing, float most_angle, bool scaled, Random& random);

}  // namespace limn::oracle
