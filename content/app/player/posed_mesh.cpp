#include "content/app/player/posed_mesh.h"

#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"
#include "render/skinning/deform_source.h"
#include "render/skinning/posed_bounds.h"
#include "systems/animation/deform_mesh.h"

namespace limn {

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
    const DeformSource source = find_deform_source(
        world, *assets, entity, instance->mesh, used_joints(mesh.skin), *deformed);
    if (!source.fault.empty()) {
        return {};
    }
    std::vector<Vec3> positions;
    const bool deforms = deform_positions(
        mesh, *deformed, source.skin, source.pose, source.morphs, source.deformers, positions,
        source.surface != nullptr ? surface_shape(source.surface, source.surface->patches)
                                  : SurfaceShape{});
    return deforms ? positions : std::vector<Vec3>{};
}

}  // namespace limn
