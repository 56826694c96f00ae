#include "systems/animation/deform_mesh.h"

#include "systems/animation/deformer_kernels.h"
#include "systems/animation/patch_kernels.h"
#include "systems/animation/skin_kernels.h"

#include <algorithm>
#include <cstddef>

// Techniques: wrinkle.compression.face-model

namespace limn {
namespace {

/// Memory of deform_positions, which is reused.
struct Memory {
    std::vector<float> weights;
    std::vector<Affine> palette;
    std::vector<DualQuaternion> duals;
};

void find_weights(const MorphWeights* morphs, std::size_t first, std::vector<float>& weights) {
    weights.clear();
    for (std::size_t i = first; morphs != nullptr && i < morphs->weights.size(); ++i) {
        weights.push_back(finite_or(morphs->weights[i], 0.0f));
    }
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
    thread_local Memory memory;
    positions = mesh.positions;
    const SkinnedVertices moved = {positions, {}, {}};
    if (surface.anchors.size() == positions.size()) {
        move_by_patches(surface, positions);
    }
    find_weights(morphs, deformed.first_morph, memory.weights);
    add_morphs(mesh.morphs, memory.weights, moved);
    if (deformers != nullptr) {
        deform_points(deformers->now, positions);
    }
    if (skin != nullptr && pose != nullptr) {
        if (!has_all_joints(mesh, *skin, *pose)) {
            positions = mesh.positions;
            return false;
        }
        const RestVertices rest = {positions, {}, {}};
        memory.palette.resize(skin->joints.size());
        compute_skin_palette(*skin, pose->joints, memory.palette);
        if (deformed.skinning == Skinning::Linear) {
            skin_linear(mesh.skin, memory.palette, rest, moved, 0, positions.size());
        } else {
            memory.duals.resize(memory.palette.size());
            compute_dual_palette(memory.palette, memory.duals);
            skin_dual(mesh.skin, memory.duals, rest, moved, 0, positions.size());
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
