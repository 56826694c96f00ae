#pragma once

#include <vector>

namespace limn {

// Reflectance of white sheen for a uniform environment, by which sheen dims what is below it
// (shaders/lib/sheen.glsl).

/// The lobe of lib/sheen.glsl: n.l times distribution times visibility; alpha = roughness^2.
[[nodiscard]] float sheen_lobe(float n_l, float n_v, float n_h, float alpha);

/// size * size values, by n.v in a row and by roughness from row to row, both from 0 to 1. Above 1
/// for smooth sheen at grazing angles, which the shader dims by it.
[[nodiscard]] std::vector<float> make_sheen_albedo(int size);

}  // namespace limn
