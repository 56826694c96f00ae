#pragma once

#include "ecs/base/result.h"

namespace limn {

struct BakeOptions;

// Maps of a relief, from heights (an image) or from a mesh seen through a side of its box; layouts
// and conventions are in content/bake/relief_map.h and odd_map.h.

// Shown by `limn bake normal heights.png -o normal.png`: bump.nm-from-height
// Shown by `limn bake normal model.glb -o normal.png`: bump.nm-from-basrelief
// Shown by `limn bake relief model.glb -o relief.png`: relief.map-bake, relief.map-format,
//     relief.thin-features
// Shown by `limn bake relief model.glb -o relief.png --set levels=true`: relief.filter
// Shown by `limn bake odd heights.png -o odd.png`: odd.bake, odd.direction, odd.index-map,
//     odd.map-format, odd.order

/// Tangent-space normals, RGB.
Status bake_normal_map(const BakeOptions& options);
/// Normal and depth, RGBA.
Status bake_relief_map(const BakeOptions& options);
/// Normal, front and back depth, RGBA, of a mesh.
Status bake_double_depth_map(const BakeOptions& options);
/// Normal, relaxed cones and depth, RGBA.
Status bake_cone_map(const BakeOptions& options);
/// Ambient occlusion, gray.
Status bake_occlusion_map(const BakeOptions& options);
/// What each view ray sees, RGBA, with the index map NAME_index.png.
Status bake_odd_map(const BakeOptions& options);

}  // namespace limn
