#pragma once

#include "ecs/components/surface.h"

namespace limn {

/// A racing craft that hovers: a hull that tapers to a needle, an engine on either side, a canopy
/// and two fins. It faces +z, its center line is y = 0. Vertex colors mark its parts: white shows
/// the material's color, the canopy, the intakes and the trim are dark.
///
/// Its nozzles are at (+-0.86, 0.05, -2.28) for a length of 5 m, of radius 0.2 m, facing -z.
struct HovercraftShape {
    float length = 5.0f;
    float detail = 0.04f;
    int triangles = 14000;
};

LIMN_FIELDS(HovercraftShape) {
    LIMN_FIELD(length, "from nozzle to nose", "m", 0.1, 1000);
    LIMN_FIELD(detail, "triangle size at a length of 5 m", "m", 0.015, 0.2);
    LIMN_FIELD(triangles, "target of the simplification; 0 = none", "", 0, 1e6);
}

[[nodiscard]] MeshData make_hovercraft(const HovercraftShape& shape);

}  // namespace limn
