#pragma once

#include "ecs/components/skeleton.h"
#include "ecs/components/surface.h"

#include <vector>

namespace limn {

// What a skeleton looks like without a body: an octahedron along each bone and a smaller one at
// each joint, faceted, bound to the joint that moves it.

struct BoneFigure {
    std::vector<MeshData> meshes;     ///< one per material that is used
    std::vector<Material> materials;  ///< middle gray, the left side blue, the right side orange
    SkinData skin;                    ///< of all meshes
};

/// The figure in the rest pose. Empty if no bone has a length. The first joint is where the scene
/// is: it has no bones.
[[nodiscard]] BoneFigure make_bone_figure(const SkeletonData& skeleton);

}  // namespace limn
