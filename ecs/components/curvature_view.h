#pragma once

#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

enum class CurvatureAxis : std::uint8_t { Tangent, Bitangent };

/// Resource: colors all meshes by the curvature that relief on them follows
/// (relief.curvature-view), along their tangents or bitangents: red convex, green flat, blue
/// concave. None if absent.
struct CurvatureView {
    CurvatureAxis axis = CurvatureAxis::Tangent;
    float full = 0.5f;
};

LIMN_FIELDS(CurvatureView) {
    LIMN_FIELD(axis, .doc = "direction on the surface", .values = "tangent bitangent");
    LIMN_FIELD(
        full, "curvature of full red or blue; a sphere of radius r has 1 / (2 r)", "1/m", 1e-6,
        1e6);
}

}  // namespace limn
