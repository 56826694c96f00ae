#include "content/load/faces/face_wrinkles.h"

#include "content/make/head/face_fold_pattern.h"
#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/wrinkle.h"
#include "ecs/world.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace limn {
namespace {

constexpr int kFoldsSize = 1024;    // of the map [px]
constexpr float kNarrowing = 0.5f;  // skin that is stretched gets narrower, without folds
constexpr float kSmoothing = 1.0f;  // sculpted shapes compress neighboring triangles unevenly

bool can_wrinkle(const Assets& assets, const MeshInstance& instance) {
    if (instance.mesh.index >= assets.meshes.size()
        || instance.material.index >= assets.materials.size()) {
        return false;
    }
    const MeshData& mesh = assets.meshes[instance.mesh.index];
    return !mesh.regions.empty() && !mesh.morphs.empty() && !mesh.uvs1.empty()
           && !mesh.tangents.empty()
           && assets.materials[instance.material.index].wrinkle_texture.image.index == kNoAsset;
}

}  // namespace

std::size_t add_face_wrinkles(World& world) {
    auto& assets = world.resource<Assets>();
    std::vector<Entity> faces;
    world.query<const Deformed, const MeshInstance, Without<WrinkleSurface>>().each(
        [&](Entity entity, const Deformed&, const MeshInstance& instance) {
            if (can_wrinkle(assets, instance)) {
                faces.push_back(entity);
            }
        });
    if (faces.empty()) {
        return 0;
    }
    FaceFoldsPattern pattern;
    pattern.image.size = kFoldsSize;
    ImageData folds = make_face_folds(pattern).normal;
    folds.name = "folds";
    const ImageId image = {static_cast<std::uint32_t>(assets.images.size())};
    assets.images.push_back(std::move(folds));
    for (const Entity face : faces) {
        auto& instance = world.get<MeshInstance>(face);
        Material skin = assets.materials[instance.material.index];
        skin.wrinkle_texture = {.image = image, .uv_set = 1};
        instance.material = {static_cast<std::uint32_t>(assets.materials.size())};
        assets.materials.push_back(std::move(skin));
        world.add(face, WrinkleSurface{.narrowing = kNarrowing, .smoothing = kSmoothing});
    }
    return faces.size();
}

}  // namespace limn
