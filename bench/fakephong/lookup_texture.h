#pragma once

#include "bench/fakephong/counted.h"
#include "bench/fakephong/phong_scene.h"

#include <functional>
#include <vector>

namespace limn::fakephong {

// Textures over the unit disc, with which one fetch per pixel replaces an illumination:
// fakephong.blinn-texture and fakephong.envmap-bake.

using DiscFunction = std::function<dvec3(double x, double y)>;

/// A square of size x size texels over [-1, 1]^2, read with bilinear filtering and clamped at its
/// edges. Of size 0 it evaluates its function: what an infinitely fine texture would hold.
struct LookupTexture {
    int size = 0;
    std::vector<dvec3> texels;
    DiscFunction exact;
};

/// Samples `function` at the texel centers; texels at the edge are 0, so that lookups beyond return
/// 0.
[[nodiscard]] LookupTexture bake_texture(int size, DiscFunction function);

/// At `at`, in [-1, 1]^2: texture address (at + 1) / 2. Counts as one fetch.
[[nodiscard]] Vec3r fetch(const LookupTexture& texture, const Vec2r& at);

/// (1 - x^2 - y^2)^(exponent / 2) in the disc, 0 outside: (N.H)^n where (x, y) is the normal's
/// projection along H; with exponent 1 the diffuse value.
[[nodiscard]] double blinn_texture_value(double exponent, double x, double y);

/// The direction of a point of the sphere map, in eye space; inverse of sphere_map_coordinates
/// inside the disc.
[[nodiscard]] dvec3 sphere_map_direction(double x, double y);

/// Sum over lights of color max(0, W.L)^n_env. Lights are taken as directional: a point light by
/// its direction from `center`. This is why the method does not support point lights.
[[nodiscard]] DiscFunction highlight_environment(const PhongScene& scene, const dvec3& center);

}  // namespace limn::fakephong
