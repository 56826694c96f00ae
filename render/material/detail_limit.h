#pragma once

#include "ecs/components/rendering.h"
#include "ecs/components/surface.h"

namespace limn {

/// What a surface falls to where `limit` is the dearest detail that is drawn. Techniques that are
/// not dearer stay as they are.
[[nodiscard]] SurfaceDetail limited_detail(SurfaceDetail detail, DetailLimit limit);

/// Whether a material has normal maps or relief that are invisible from afar: not those whose mip
/// levels widen highlights (Material::normal_mips), nor those that are the shape itself (normals of
/// the object, double depth).
[[nodiscard]] bool has_fine_detail(const Material& material);
/// The same material without: what is left of it where it is small in the image
/// (engine.lod-shader).
[[nodiscard]] Material without_fine_detail(Material material);

}  // namespace limn
