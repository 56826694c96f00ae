#pragma once

#include "content/load/gltf_document.h"
#include "content/load/gltf_scene.h"

namespace limn {

/// Fills `scene.materials`, in the file's order with the default material after them, and
/// `scene.images` with the pictures they use: an image that serves as color and as data is there
/// twice, as the GPU decodes only one of them from sRGB.
[[nodiscard]] Status build_materials(GltfDocument& document, GltfScene& scene);

}  // namespace limn
