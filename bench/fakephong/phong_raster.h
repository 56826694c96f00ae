#pragma once

#include "bench/fakephong/counted.h"
#include "bench/fakephong/phong_scene.h"
#include "bench/fakephong/shading_method.h"
#include "content/bake/image_compare.h"

#include <cstdint>
#include <vector>

namespace limn::fakephong {

// A rasterizer for reading: one triangle at a time, rows from the top, a depth buffer. It clips at
// the eye's near plane and steps s/w, t/w and 1/w along a row by additions
// (fakephong.forward-difference, .texmap); each pixel divides, and asks the method for light at (s,
// t). Triangles that face away, have no area or hold NaN are left out.

struct PhongImage {
    ColorImage color;                ///< 0 .. 1, not rounded
    std::vector<std::uint8_t> mask;  ///< 1 where a triangle was drawn
    std::int64_t pixels = 0;         ///< shaded, including those that others hide later
    std::int64_t triangles = 0;      ///< drawn at least in part
    Work setup;                      ///< of all triangles, once each
    Work shading;                    ///< of all pixels
};

/// The image of `scene` by `method`. The scene must pass check_scene.
[[nodiscard]] PhongImage draw(const PhongScene& scene, const ShadingMethod& method);

/// The facet of triangle `index`, with normals made valid; false if it has no area or no finite
/// place.
[[nodiscard]] bool make_facet(const PhongMesh& mesh, std::size_t index, Facet& facet);

/// What is seen of it: light and texture together, each channel clamped to 0 .. 1.
[[nodiscard]] dvec3 seen_color(const PhongScene& scene, const Lit& lit, const dvec2& uv);

}  // namespace limn::fakephong
