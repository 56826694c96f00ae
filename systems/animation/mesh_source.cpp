#include "systems/animation/mesh_source.h"

#include "systems/animation/deform_mesh.h"

namespace limn {

MeshSource find_mesh_source(
    MeshId mesh, const Deformed* deformed, const DeformerState* deformers,
    const Query<const Pose>& poses, const Query<const MorphWeights>& morphs, const Assets& assets,
    const SurfaceBindingState* binding) {
    MeshSource source{.mesh = mesh};
    if (mesh.index >= assets.meshes.size()) {
        return source;
    }
    source.data = &assets.meshes[mesh.index];
    if (deformed != nullptr) {
        source.deformed = deformed;
        const bool follows_faces = binding != nullptr && !binding->pose.joints.empty();
        const SkinId skin = follows_faces ? binding->skin : deformed->skin;
        source.skin = skin.index < assets.skins.size() ? &assets.skins[skin.index] : nullptr;
        source.pose = follows_faces ? &binding->pose : poses.find<const Pose>(deformed->character);
        source.morphs = morphs.find<const MorphWeights>(deformed->character);
        source.deformers = deformers;
        if (binding != nullptr) {
            source.surface = surface_shape(binding, binding->patches);
        }
    }
    return source;
}

void transform_vertices(
    const MeshSource& source, const Affine& world, std::vector<Vec3>& positions) {
    if (source.deformed != nullptr) {
        deform_positions(
            *source.data, *source.deformed, source.skin, source.pose, source.morphs,
            source.deformers, positions, source.surface);
    } else {
        positions = source.data->positions;
    }
    for (Vec3& position : positions) {
        position = transform_point(world, position);
    }
}

}  // namespace limn
