#pragma once

#include "content/load/gltf/gltf_scene.h"
#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

struct SceneAtlasOptions {
    int max_size = 8192;  ///< of an image [px]
    float gutter = 8;     ///< around each texture, in pixels of a cell of 512
};

struct SceneAtlasReport {
    std::size_t materials_before = 0;
    std::size_t materials = 0;
    std::size_t images_before = 0;
    std::size_t images = 0;
    std::vector<std::string> kept;  ///< why a material keeps its own textures, a line each
};

/// Materials of the scene that differ only in their textures become one, whose textures are atlases
/// (texture_atlas.h), and the texture coordinates of their meshes move there. A material keeps its
/// own where these are not within 0 .. 1, since an atlas cannot tile, where a texture is moved or
/// of the second set, or not of 8 bits.
[[nodiscard]] SceneAtlasReport
merge_materials(GltfScene& scene, const SceneAtlasOptions& options = {});

}  // namespace limn
