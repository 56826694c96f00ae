#pragma once

#include "content/make/four.h"
#include "content/make/head/head.h"
#include "ecs/base/math.h"

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace limn {

// Building blocks of a head's implicit surface, in centimeters: solids that blend into one another,
// and strokes that raise or lower their surface.

/// An ellipsoid swept from `a` to `b`, with radii that change from `ra` to `rb`.
struct Solid {
    Vec3 a, b;
    Vec3 ra, rb;
    float blend;  ///< width of the transition to the previous solids [cm]; < 0: carved out
};

/// A quadratic Bezier curve of clay.
struct Stroke {
    Vec3 a, b, c;
    float radius;
    float amount;     ///< height on the surface [cm]; < 0: a groove
    float sex = 0;    ///< added to `amount` times HeadShape::sex ...
    float build = 0;  ///< ... build ...
    float age = 0;    ///< ... and age - 0.3
};

/// Adds `solids` in order to the surface at `distance` from `p`. Number: float or Four.
template <typename Number>
[[nodiscard]] Number join(Number distance, std::span<const Solid> solids, const PointOf<Number>& p);

/// A stroke as chords, and the box beyond which less than exp(-9) of it remains.
struct StrokePath {
    std::array<Vec3, 7> points;
    Vec3 low, high;
};

/// `map`: moves points of the curves, for example onto a surface.
[[nodiscard]] std::vector<StrokePath> make_stroke_paths(
    std::span<const Stroke> strokes, const std::function<Vec3(const Vec3&)>& map = nullptr);

/// How much `strokes` raise the surface at `p` [cm]. Number: float or Four.
template <typename Number>
[[nodiscard]] Number relief(
    std::span<const Stroke> strokes, std::span<const StrokePath> paths, const PointOf<Number>& p,
    const HeadShape& shape);

}  // namespace limn
