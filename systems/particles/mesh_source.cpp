#include "systems/particles/mesh_source.h"

#include "systems/animation/deform_mesh.h"

namespace limn {

MeshSource find_mesh_source(
    const MeshInstance& instance, const Deformed* deformed, const DeformerState* deformers,
    const Query<const Pose>& poses, const Query<const MorphWeights>& morphs, const Assets& assets) {
    MeshSource source{.mesh = instance.mesh};
    if (instance.mesh.index >= assets.meshes.size()) {
        return source;
    }
    source.data = &assets.meshes[instance.mesh.index];
    if (deformed != nullptr) {
        source.deformed = deformed;
        source.skin = deformed->skin.index < assets.skins.size()
                          ? &assets.skins[deformed->skin.index]
                          : nullptr;
        source.pose = poses.find<const Pose>(deformed->character);
        source.morphs = morphs.find<const MorphWeights>(deformed->character);
        source.deformers = deformers;
    }
    return source;
}

void place_vertices(const MeshSource& source, const Affine& world, std::vector<Vec3>& positions) {
    if (source.deformed != nullptr) {
        deform_positions(
            *source.data, *source.deformed, source.skin, source.pose, source.morphs,
            source.deformers, positions);
    } else {
        positions = source.data->positions;
    }
    for (Vec3& position : positions) {
        position = transform_point(world, position);
    }
}

}  // namespace limn
