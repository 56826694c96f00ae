#pragma once

#include "ecs/base/math.h"

#include <cstdint>
#include <vector>

namespace limn {

/// A triangle at a vertex, and its share of the vertex's compression.
struct WrinkleCorner {
    std::uint32_t triangle = 0;
    float weight = 0.0f;  ///< of all at a vertex: sum 1
};

/// A mesh at rest with one direction across its wrinkles, prepared for measuring how much shorter
/// its skin has become in that direction. Made once per mesh.
struct WrinkleRest {
    std::vector<std::uint32_t> corners;  ///< three vertices per triangle
    std::vector<Vec2>
        across;  ///< per triangle the unit direction in its plane as x e1 + y e2, e1
                 ///< and e2 the edges from its first vertex at rest [1/m]; (0, 0): none
    std::vector<WrinkleCorner> around;  ///< triangles that have a direction, vertex after vertex
    std::vector<std::uint32_t> first;   ///< per vertex and one more: index of its first in `around`
};

}  // namespace limn
