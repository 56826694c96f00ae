#pragma once

#include "ecs/base/math.h"

#include <cstdint>
#include <string>
#include <vector>

namespace limn {

// Markers on the skin of a head, each a vertex of it, and the surface through them that moves the
// head by patches (face.bids-surface): rings around mouth, eyes and nostrils that follow their
// loops (head_layout.h), few elsewhere. Triangles connect what are neighbors on the unrolled skin,
// not in space: each lip and each lid has markers of its own, though lips touch, and no triangle
// spans an opening. Some of a ring lie within the mouth, behind the lids and on the ears, where
// nobody is marked; a recording that lacks them moves them with their neighbors.

struct HeadMarkers {
    // One per vertex of the surface: a marker on the seam of the texture has two.
    std::vector<std::string> names;       ///< "mouth11_90_M": loop, angle [degrees] and side
    std::vector<std::uint32_t> vertices;  ///< of head_layout()
    std::vector<Vec2> charts;             ///< of the vertices; beyond the seam a turn farther
    std::vector<std::uint32_t> indices;   ///< three per triangle, seen from outside
};

/// Mirror images of each other on both sides.
[[nodiscard]] const HeadMarkers& head_markers();

}  // namespace limn
