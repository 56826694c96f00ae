#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <utility>
#include <vector>

namespace limn {

// Fits the coarse surface of one face to another (face.retarget-fit) and transfers its motion, the
// morph targets (face.retarget-warp): a performance of one head drives another that is bound
// to the result. Joints are kept from the first head.

struct RetargetedShape {
    MeshId mesh;
    MeshId from;
    MeshId onto;
    float gain = 1.0f;
    float stiffness = 0.2f;
};

LIMN_FIELDS(RetargetedShape) {
    LIMN_FIELD(
        mesh, "surface of the first face, by name; all meshes must come earlier in the file");
    LIMN_FIELD(from, "the first face, with regions");
    LIMN_FIELD(onto, "the other face, with the same regions");
    LIMN_FIELD(gain, "exaggeration of the motion", "", 0, 10);
    LIMN_FIELD(
        stiffness, "cost of strain and of bending of the fitted surface, relative to distance", "",
        0, 100);
}

/// Corresponding points: for each region that both meshes have, the centers of its left and right
/// half, and the extremes along the axes.
[[nodiscard]] std::pair<std::vector<Vec3>, std::vector<Vec3>>
corresponding_points(const MeshData& from, const MeshData& onto);

/// `surface` of the face `from`, fitted to the face `onto`. Fails with one line when the meshes
/// have too few regions in common.
[[nodiscard]] Result<MeshData> retarget_surface(
    const MeshData& surface, const MeshData& from, const MeshData& onto, float gain,
    float stiffness);

/// The same for meshes of a level. A failure is logged, and the surface left unchanged. Empty
/// without a mesh.
[[nodiscard]] MeshData make_retargeted(const RetargetedShape& shape, const Assets& assets);

}  // namespace limn
