#pragma once

#include "ecs/base/math.h"

namespace limn {

struct Material;

/// Color of the material's pigments, a factor of its base color, linear; (1, 1, 1) without
/// pigments.
///
/// Plane: (0.97, 0.87, 0.67) - melanin (0.69, 0.71, 0.90) - blood (0, 0.24, 0.24), clamped at 0
/// (skin.melanin-blood; Bando 2001, after Cotton et al. 1999). Values without physical meaning.
///
/// Density: a base times exp(-absorption). Melanin 0 .. 1 goes from the albedo of fair skin (types
/// I and II) to that of dark skin (type VI); blood 0 is pale, 0.2 normal, 0.5 a blushing cheek, 1
/// lips. Fitted to CIE L*a*b* of skin types; intermediate types agree within 20 %.
[[nodiscard]] Vec3 skin_tone(const Material& material);

}  // namespace limn
