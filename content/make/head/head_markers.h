#pragma once

#include "ecs/base/math.h"

#include <cstdint>
#include <string>
#include <vector>

namespace limn {

// Markers at vertices of the skin of a head, and the surface through them that moves the head by
// patches (face.bids-surface): rings around mouth, eyes and nostrils that follow their loops
// (head_layout.h), few elsewhere. Triangles connect neighbors on the unrolled skin, not in space:
// each lip and each lid has its own markers, though lips touch, and no triangle spans an opening.
// Some markers lie inside the mouth, behind the lids and on the ears, where real faces have none;
// with a recording that lacks them they move with their neighbors.

struct HeadMarkers {
    // One per vertex of the surface: a marker on the seam of the texture has two.
    std::vector<std::string> names;       ///< "mouth11_90_M": loop, angle [degrees] and side
    std::vector<std::uint32_t> vertices;  ///< of head_layout()
    std::vector<Vec2> charts;             ///< of the vertices; beyond the seam plus a full turn
    std::vector<std::uint32_t> indices;   ///< three per triangle, counter-clockwise from outside
};

/// Both sides are mirror images.
[[nodiscard]] const HeadMarkers& head_markers();

}  // namespace limn
