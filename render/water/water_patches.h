#pragma once

#include "ecs/base/math.h"
#include "render/culling.h"

#include <vector>

namespace limn {

// Which squares of a body of water are drawn, and how finely: a quadtree over its rest surface,
// finer near the camera (Strugar, "Continuous Distance-Dependent Level of Detail", 2009). Each
// square is drawn with the same grid of layout::kWaterGrid cells a side; toward the distance where
// squares twice as large take over, every second vertex slides onto its neighbor, so that there is
// neither a crack nor a jump. Vertices stay where they are in the water's own space, however the
// camera moves.

inline constexpr float kLeastDetail = 2.2f;
inline constexpr int kMaxWaterPatches = 8192;
inline constexpr float kWaterReach = 32768.0f;  ///< that water without end has at least [m]

/// As water.vert reads it: two texels.
struct WaterPatch {
    Vec2 corner = {0, 0};   ///< least x and z, in the water's own space [m]
    float size = 1;         ///< of the side [m]
    float body = 0;         ///< index of the body of water
    float morph_begin = 0;  ///< distance from the camera at which vertices begin to slide [m]
    float morph_end = 1;    ///< at which they have arrived [m]
    Vec2 unused = {0, 0};
};
static_assert(sizeof(WaterPatch) == 32);

/// A body of water as its squares are chosen, in its own space.
struct PatchSource {
    Vec2 half = {0, 0};           ///< half extents of the rectangle; 0: without end [m]
    Vec3 camera = {0, 0, 0};      ///< [m]
    Vec3 margin = {0, 0, 0};      ///< by which waves move the surface, at most [m]
    Frustum frustum;              ///< what the camera sees
    float finest = 1;             ///< squares of this side, > 0, or less are not cut up [m]
    float detail = kLeastDetail;  ///< squares are as large as their distance over this, >= 2
    float body = 0;
};

/// Appends the squares that may be seen. There are never more than kMaxWaterPatches in all; then
/// the last ones are larger than they should be, or missing.
void append_water_patches(const PatchSource& source, std::vector<WaterPatch>& patches);

}  // namespace limn
