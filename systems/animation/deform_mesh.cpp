#include "systems/animation/deform_mesh.h"

#include "systems/animation/deformer_kernels.h"
#include "systems/animation/patch_kernels.h"
#include "systems/animation/skin_kernels.h"

#include <algorithm>
#include <cstddef>
#include <span>

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

/// Whether the pose has the first `used` joints of the skin.
bool has_joints(const SkinData& skin, std::size_t used, const Pose& pose) {
    return used <= skin.joints.size()
           && std::ranges::all_of(std::span(skin.joints).first(used), [&pose](std::size_t joint) {
                  return joint < pose.joints.size();
              });
}

}  // namespace

bool deform_positions(
    const MeshData& mesh, const Deformed& deformed, const SkinData* skin, const Pose* pose,
    const MorphWeights* morphs, const DeformerState* deformers, std::vector<Vec3>& positions,
    const SurfaceShape& surface) {
    thread_local Memory memory;
    positions = mesh.positions;
    const SkinnedVertices moved = {positions, {}, {}};
    if (!surface.anchors.empty() && surface.anchors.size() >= positions.size()) {
        move_by_patches(surface, positions);
    }
    find_weights(morphs, deformed.first_morph, memory.weights);
    add_morphs(mesh.morphs, memory.weights, moved);
    if (deformers != nullptr) {
        deform_points(deformers->now, positions);
    }
    if (skin != nullptr && pose != nullptr) {
        const std::size_t used = used_joints(mesh.skin);
        if (!has_joints(*skin, used, *pose)) {
            positions = mesh.positions;
            return false;
        }
        const RestVertices rest = {positions, {}, {}};
        memory.palette.resize(used);
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
