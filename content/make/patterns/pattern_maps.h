#pragma once

#include "ecs/components/surface.h"

#include <functional>

namespace limn {

// Renders a function of uv into the texture maps of a procedural material.

/// Material of a pattern at a point of the surface.
struct PatternTexel {
    Vec3 color = {0.5f, 0.5f, 0.5f};  ///< linear, 0 .. 1
    float height = 0;                 ///< in units of the image width
    float roughness = 0.5f;           ///< perceptual, 0 .. 1
    float metalness = 0;              ///< 0 .. 1
    float occlusion = 1;              ///< visible fraction of the sky, 0 .. 1
    float opacity = 1;                ///< 0 .. 1
};

/// Square images of one size that tile in both directions.
struct PatternMaps {
    ImageData base_color;  ///< sRGB, and opacity
    ImageData normal;      ///< tangent space, green up, from the heights
    ImageData orm;         ///< r occlusion, g roughness, b metalness, as glTF packs them
    ImageData motion;      ///< for flipbooks, as ParticleLook::motion; else empty
    /// For flipbooks of volumes, else empty: the light that they scatter from the right, above
    /// and behind, with their opacity; see ParticleLook::negative_light.
    ImageData positive_light, negative_light;
    /// For stone with relief, else empty: normals, and depth in alpha, of the heights between 0 and
    /// 1 (Material::relief_texture). Blue: relaxed cones (cone_map.h); or, where some texel has no
    /// opacity, the back: the bottom, or in front of the surface of such texels.
    ImageData relief;
};

/// Calls texel(uv) once for the center of every pixel, on several threads; `size` >= 1 pixels.
/// Differences of height wrap around at the edges of the image.
[[nodiscard]] PatternMaps
make_pattern_maps(int size, const std::function<PatternTexel(const Vec2& uv)>& texel);

/// Likewise, with a relief map whose depth of 1 is `relief` image widths; the heights of texels are
/// 0 .. 1 of that.
[[nodiscard]] PatternMaps
make_relief_maps(int size, float relief, const std::function<PatternTexel(const Vec2& uv)>& texel);

/// Likewise, with normals for skin that folds (write_wrinkle_map).
[[nodiscard]] PatternMaps
make_wrinkle_maps(int size, const std::function<PatternTexel(const Vec2& uv)>& texel);

}  // namespace limn
