#pragma once

#include "ecs/components/surface.h"

namespace limn {

/// A racing craft that hovers: a hull that tapers to a needle, an engine on either side, a canopy
/// and two fins. It faces +z, its middle line is y = 0. Vertex colors mark its parts: white takes
/// the material's color, the canopy, the intakes and the trim are dark.
///
/// Its nozzles are at (+-0.86, 0.05, -2.28) for a length of 5 m, of radius 0.2 m, facing -z.
struct HovercraftShape {
    float length = 5.0f;    ///< from nozzle to nose [m], > 0
    float detail = 0.04f;   ///< size of the triangles of a craft of 5 m [m]
    int triangles = 14000;  ///< simplified to about so many; 0 = not at all
};

[[nodiscard]] MeshData make_hovercraft(const HovercraftShape& shape);

template <typename Visitor>
void visit_fields(HovercraftShape& shape, Visitor&& visit) {
    visit(
        "length", shape.length,
        {.doc = "from nozzle to nose", .unit = "m", .min = 0.1, .max = 1000});
    visit(
        "detail", shape.detail,
        {.doc = "size of the triangles of a craft of 5 m", .unit = "m", .min = 0.015, .max = 0.2});
    visit(
        "triangles", shape.triangles,
        {.doc = "simplified to about so many; 0 = not at all", .min = 0, .max = 1e6});
}

}  // namespace limn
