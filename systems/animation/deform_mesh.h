#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/deformers.h"
#include "ecs/components/surface.h"
#include "ecs/components/surface_anchors.h"

#include <vector>

namespace limn {

/// Vertex positions of a mesh in its own space, deformed by the surface it is bound to, morph
/// targets, deformers and joints on the CPU, to `positions`, which is resized; about a millisecond
/// for 50,000 vertices without deformers. `skin`, `pose`, `morphs` and `deformers` may be null: at
/// rest. False, and at rest, if a joint is missing in skin or pose or a position would not be
/// finite.
bool deform_positions(
    const MeshData& mesh, const Deformed& deformed, const SkinData* skin, const Pose* pose,
    const MorphWeights* morphs, const DeformerState* deformers, std::vector<Vec3>& positions,
    const SurfaceShape& surface = {});

}  // namespace limn
