#include "systems/animation/deform_mesh.h"

#include "systems/animation/deformer_kernels.h"
#include "systems/animation/skin_kernels.h"
#include "systems/animation/surface_patches.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace limn {
namespace {

std::vector<float> weights_of(const MorphWeights* morphs, std::size_t first) {
    std::vector<float> weights;
    for (std::size_t i = first; morphs != nullptr && i < morphs->weights.size(); ++i) {
        weights.push_back(std::isfinite(morphs->weights[i]) ? morphs->weights[i] : 0.0f);
    }
    return weights;
}

bool has_all_joints(const MeshData& mesh, const SkinData& skin, const Pose& pose) {
    const auto below = [](std::size_t count) {
        return [count](std::size_t joint) { return joint < count; };
    };
    return std::all_of(mesh.skin.joints.begin(), mesh.skin.joints.end(), below(skin.joints.size()))
           && std::all_of(skin.joints.begin(), skin.joints.end(), below(pose.joints.size()));
}

}  // namespace

bool deform_positions(
    const MeshData& mesh, const Deformed& deformed, const SkinData* skin, const Pose* pose,
    const MorphWeights* morphs, const DeformerState* deformers, std::vector<Vec3>& positions,
    const SurfaceShape& surface) {
    positions = mesh.positions;
    std::vector<Vec3> normals(positions.size(), Vec3(0, 0, 1));
    std::vector<Vec4> tangents(positions.size(), Vec4(1, 0, 0, 1));
    const SkinnedVertices moved = {positions, normals, tangents};
    if (surface.places.size() == positions.size()) {
        follow_patches(surface.places, surface.patches, positions, normals, tangents);
    }
    add_morphs(mesh.morphs, weights_of(morphs, deformed.first_morph), moved);
    if (deformers != nullptr) {
        deform_points(deformers->now, positions);
    }
    if (skin != nullptr && pose != nullptr) {
        if (!has_all_joints(mesh, *skin, *pose)) {
            positions = mesh.positions;
            return false;
        }
        const RestVertices rest = {positions, normals, tangents};
        std::vector<Affine> palette(skin->joints.size());
        compute_skin_palette(*skin, pose->joints, palette);
        if (deformed.skinning == Skinning::Linear) {
            skin_linear(mesh.skin, palette, rest, moved, 0, positions.size());
        } else {
            std::vector<DualQuaternion> duals(palette.size());
            compute_dual_palette(palette, duals);
            skin_dual(mesh.skin, duals, rest, moved, 0, positions.size());
        }
    }
    const bool finite =
        std::all_of(positions.begin(), positions.end(), [](const Vec3& p) { return is_finite(p); });
    if (!finite) {
        positions = mesh.positions;
    }
    return finite;
}

}  // namespace limn
