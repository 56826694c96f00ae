#pragma once

#include "ecs/components/surface.h"

#include <functional>

namespace limn {

// The images of one procedural material, from a function that says what is at a place.

/// What a pattern says of a point of the surface.
struct PatternTexel {
    Vec3 color = {0.5f, 0.5f, 0.5f};  ///< linear, 0 .. 1
    float height = 0;                 ///< in widths of the image
    float roughness = 0.5f;           ///< perceptual, 0 .. 1
    float metalness = 0;              ///< 0 .. 1
    float occlusion = 1;              ///< share of the sky that is seen, 0 .. 1
};

/// Three square images of one size that tile in both directions.
struct PatternMaps {
    ImageData base_color;  ///< sRGB
    ImageData normal;      ///< tangent space, green up, from the heights
    ImageData orm;         ///< r occlusion, g roughness, b metalness, as glTF packs them
};

/// Calls texel(uv) once for the middle of every pixel, on several threads; `size` >= 1 pixels. The
/// height is differenced across the edges of the image as if it repeated.
[[nodiscard]] PatternMaps
make_pattern_maps(int size, const std::function<PatternTexel(const Vec2& uv)>& texel);

}  // namespace limn
