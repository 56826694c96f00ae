#pragma once

#include "content/load/gltf_document.h"
#include "ecs/components/surface.h"

#include <optional>

namespace limn {

/// Primitive `primitive` of mesh `mesh` as triangles with normals, tangents, bounds, weights of
/// joints where a node skins it, and morph targets; only the vertices that its triangles use.
/// Nothing when there is nothing to draw: points, lines, no positions; then a warning is left in
/// the document.
[[nodiscard]] Result<std::optional<MeshData>>
build_mesh(GltfDocument& document, std::size_t mesh, std::size_t primitive);

}  // namespace limn
