#pragma once

#include "content/load/gltf_document.h"
#include "content/load/gltf_scene.h"

namespace limn {

/// Fills the components of the nodes of `scene` from extras.limn of the file's nodes; they may name
/// nodes and all assets of the scene. Fails at an unknown component, field or name and at a value
/// of the wrong type.
[[nodiscard]] Status read_extras(const GltfDocument& document, GltfScene& scene);

}  // namespace limn
