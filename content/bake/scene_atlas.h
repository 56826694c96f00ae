#pragma once

#include "content/load/gltf/gltf_scene.h"
#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

struct SceneAtlasOptions {
    int max_size = 8192;  ///< of an image [px]
    float gutter = 16;    ///< around each texture, in pixels of a cell of 512
};

struct SceneAtlasReport {
    std::size_t materials_before = 0;
    std::size_t materials = 0;
    std::size_t images_before = 0;
    std::size_t images = 0;
    std::vector<std::string> notes;  ///< what is not as one may expect, a line each
};

/// Materials of the scene that differ only in their textures become one, whose textures are atlases
/// (texture_atlas.h), and the texture coordinates of their meshes move there; what no node has is
/// dropped. A material keeps its own textures where texture coordinates are not within 0 .. 1,
/// since an atlas cannot tile, where it has a texture transform, TEXCOORD_1 or maps that glTF does
/// not have, and where an image is not of 8 bits. Nodes must have no components.
[[nodiscard]] SceneAtlasReport
merge_materials(GltfScene& scene, const SceneAtlasOptions& options = {});

}  // namespace limn
