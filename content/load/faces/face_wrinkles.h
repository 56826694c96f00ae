#pragma once

#include <cstddef>

namespace limn {

class World;

/// Lets the skin of faces wrinkle at once: every deformed mesh with wrinkle regions, tangents and
/// texture coordinates of the built-in head (uv set 1, as `limn import` writes them), whose
/// material has no wrinkle map, gets the folds of face_folds and a WrinkleSurface. `world` has the
/// resource Assets. Returns the number of those meshes.
std::size_t add_face_wrinkles(World& world);

}  // namespace limn
