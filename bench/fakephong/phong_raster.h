#pragma once

#include "bench/fakephong/counted.h"
#include "bench/fakephong/phong_scene.h"
#include "bench/fakephong/shading_method.h"
#include "content/bake/image_compare.h"

#include <cstdint>
#include <vector>

namespace limn::fakephong {

// A rasterizer that is easy to read: one triangle at a time, rows from the top, a depth buffer. It
// clips at the eye's near plane and steps s/w, t/w and 1/w along a row by additions
// (fakephong.texmap); each pixel divides, and evaluates the method at (s, t). Triangles that face
// away, have no area or contain NaN are skipped.
//
// With Interpolation::Screen nothing is divided: s and t themselves are linear on the screen, so
// that colors which are polynomials in s and t are also polynomials in x and y. These can then be
// stepped by additions only, down the left edge of a triangle and along each row
// (fakephong.forward-difference).

struct PhongImage {
    ColorImage color;                ///< 0 .. 1, not rounded
    std::vector<std::uint8_t> mask;  ///< 1 where a triangle was drawn
    std::int64_t pixels = 0;         ///< shaded, including those that are overdrawn later
    std::int64_t triangles = 0;      ///< drawn at least in part
    Work setup;                      ///< of all triangles, once each
    Work shading;  ///< of all pixels; with Differences, including the steps along edges
};

/// How pixel colors are computed.
enum class Evaluation : std::uint8_t {
    Direct,       ///< the method is evaluated at each pixel
    Differences,  ///< forward differences; needs method.degree > 0 and Interpolation::Screen
};

/// The image of `scene` by `method`. The scene must pass check_scene.
[[nodiscard]] PhongImage draw(
    const PhongScene& scene, const ShadingMethod& method,
    Evaluation evaluation = Evaluation::Direct);

/// The facet of triangle `index`, with normals made valid; false if it has no area or is not
/// finite.
[[nodiscard]] bool make_facet(const PhongMesh& mesh, std::size_t index, Facet& facet);

/// Its visible color: light and texture together, each channel clamped to 0 .. 1.
[[nodiscard]] dvec3 visible_color(const PhongScene& scene, const Lit& lit, const dvec2& uv);

}  // namespace limn::fakephong
