#include "content/app/posed_mesh.h"

#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"
#include "render/skinning/deform_source.h"
#include "render/skinning/posed_bounds.h"
#include "systems/animation/skin_kernels.h"

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

std::uint32_t joint_count(const SkinWeights& skin) {
    const auto last = std::max_element(skin.joints.begin(), skin.joints.end());
    return last != skin.joints.end() ? *last + 1u : 0u;
}

std::vector<float> weights_of(const MorphWeights* morphs, std::size_t first) {
    std::vector<float> weights;
    for (std::size_t i = first; morphs != nullptr && i < morphs->weights.size(); ++i) {
        weights.push_back(std::isfinite(morphs->weights[i]) ? morphs->weights[i] : 0.0f);
    }
    return weights;
}

}  // namespace

std::vector<Vec3> posed_positions(const World& world, Entity entity) {
    const auto* assets = world.find_resource<Assets>();
    const auto* deformed = world.find<Deformed>(entity);
    const auto* instance = world.find<MeshInstance>(entity);
    if (assets == nullptr || deformed == nullptr || instance == nullptr
        || instance->mesh.index >= assets->meshes.size()) {
        return {};
    }
    const MeshData& mesh = assets->meshes[instance->mesh.index];
    if (!check_deformable(mesh).empty()) {
        return {};
    }
    const DeformSource source =
        find_deform_source(world, *assets, instance->mesh, joint_count(mesh.skin), *deformed);
    if (!source.fault.empty()) {
        return {};
    }
    std::vector<Vec3> positions = mesh.positions;
    std::vector<Vec3> normals(positions.size(), Vec3(0, 0, 1));
    std::vector<Vec4> tangents(positions.size(), Vec4(1, 0, 0, 1));
    const SkinnedVertices moved = {positions, normals, tangents};
    add_morphs(mesh.morphs, weights_of(source.morphs, deformed->first_morph), moved);
    if (source.skin == nullptr) {
        return positions;
    }
    const RestVertices rest = {positions, normals, tangents};
    std::vector<Affine> palette(source.skin->joints.size());
    compute_skin_palette(*source.skin, source.pose->joints, palette);
    if (deformed->skinning == Skinning::Linear) {
        skin_linear(mesh.skin, palette, rest, moved, 0, positions.size());
    } else {
        std::vector<DualQuaternion> duals(palette.size());
        compute_dual_palette(palette, duals);
        skin_dual(mesh.skin, duals, rest, moved, 0, positions.size());
    }
    const bool finite = std::all_of(positions.begin(), positions.end(), [](const Vec3& p) {
        return std::isfinite(p.x + p.y + p.z);
    });
    return finite ? positions : std::vector<Vec3>{};  // as it is drawn: at rest
}

}  // namespace limn
