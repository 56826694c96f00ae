#pragma once

#include "ecs/base/result.h"

namespace limn {

// Shown by `limn bake atlas tiles.gltf -o tiles.glb`: engine.texture-atlas

struct BakeOptions;

/// Writes a model whose materials that differ only in their textures are one, with atlases.
[[nodiscard]] Status bake_atlas(const BakeOptions& options);

}  // namespace limn
