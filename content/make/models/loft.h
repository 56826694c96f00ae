#pragma once

#include "ecs/base/math.h"

#include <span>
#include <vector>

namespace limn {

// Limbs by their cross-sections: a tube along a smooth curve, whose sections are four quarters of
// ellipses, each with a radius of its own. As a distance it blends with other parts
// (implicit_model.h). The curve and the radii are Catmull-Rom splines through the stations.

/// Radii are toward `right`, `up`, and their opposites, where right = direction of the curve x up.
struct LoftStation {
    Vec3 center = {0, 0, 0};
    float right = 1;
    float up = 1;
    float left = 1;
    float down = 1;
};

struct LoftShape {
    std::span<const LoftStation> stations;  ///< two or more, from one end to the other
    Vec3 up = {0, 0, 1};                    ///< not along the curve
    float first_cap = 0.5f;                 ///< length of the rounded end before the first station
    float last_cap = 0.5f;                  ///< and after the last one
};

/// One piece between two sections, ready for evaluation.
struct LoftPiece {
    Vec3 begin, axis;  ///< `axis` from begin to end
    Vec3 right, up;    ///< unit, perpendicular to the axis
    Vec4 first, last;  ///< radii of both sections: right, up, left, down
    float first_cap;   ///< length of the rounded end before it; 0: another piece is there
    float last_cap;    ///< and after it
    float length2;     ///< of the axis, squared
};

struct Loft {
    std::vector<LoftPiece> pieces;
    Vec3 center = {0, 0, 0};  ///< of a ball around it
    float reach = 0;          ///< radius of that ball
};

[[nodiscard]] Loft make_loft(const LoftShape& shape);

/// < 0 inside; near the surface, about the distance to it.
[[nodiscard]] float loft_distance(const Loft& loft, const Vec3& p);

}  // namespace limn
