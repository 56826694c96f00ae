#pragma once

#include "ecs/base/math.h"
#include "ecs/components/animation.h"
#include "ecs/components/deformers.h"
#include "ecs/components/surface.h"
#include "ecs/components/surface_binding.h"
#include "ecs/query.h"

#include <vector>

namespace limn {

/// The mesh of an entity in this step, with its deformers. Points to components and assets.
struct MeshSource {
    MeshId mesh{};
    const MeshData* data = nullptr;  ///< null: no such mesh
    const Deformed* deformed = nullptr;
    const SkinData* skin = nullptr;
    const Pose* pose = nullptr;
    const MorphWeights* morphs = nullptr;
    const DeformerState* deformers = nullptr;
    SurfaceShape surface = {};
};

/// `deformed`, `deformers` and `binding` are those of the entity, or null.
[[nodiscard]] MeshSource find_mesh_source(
    MeshId mesh, const Deformed* deformed, const DeformerState* deformers,
    const Query<const Pose>& poses, const Query<const MorphWeights>& morphs, const Assets& assets,
    const SurfaceBindingState* binding = nullptr);

/// Writes its deformed vertices, transformed by `world`, to `positions`, which is resized.
void transform_vertices(
    const MeshSource& source, const Affine& world, std::vector<Vec3>& positions);

}  // namespace limn
