#pragma once

#include "ecs/base/math.h"
#include "ecs/components/water_waves.h"
#include "render/geometry/culling.h"

#include <span>
#include <vector>

namespace limn {

// Continuous LOD for water: a quadtree over the rest surface selects square patches, finer near the
// camera (CDLOD; Strugar, "Continuous Distance-Dependent Level of Detail", 2009). Each patch is
// drawn with the same grid of layout::kWaterGrid cells per side; toward the distance of the next
// coarser level every second vertex morphs onto its neighbor, so there are neither cracks nor
// popping. Where no wave displaces a patch, a fan of triangles replaces its interior; its border
// keeps its vertices.
// Vertices are fixed in the water's own space, however the camera moves.

inline constexpr float kMinPatchDetail = 2.2f;
inline constexpr int kMaxWaterPatches = 8192;
inline constexpr float kWaterRange =
    32768.0f;  ///< minimum extent of unbounded water around the camera [m]

/// Layout of water.vert: two texels.
struct WaterPatch {
    Vec2 corner = {0, 0};   ///< minimum x and z, in the water's own space [m]
    float size = 1;         ///< side [m]
    float body = 0;         ///< index of the body of water
    float morph_begin = 0;  ///< distance from the camera at which morphing begins [m]
    float morph_end = 1;    ///< distance at which it ends [m]
    float lines = 0;        ///< number of leading, longest wave lines that its vertices resolve
    float variance = 0;     ///< of the slopes of the other lines
};
static_assert(sizeof(WaterPatch) == 32);

/// Parameters of patch selection for a body of water, in its own space.
struct PatchSource {
    Vec2 half = {0, 0};              ///< half extents of the rectangle [m]; 0: unbounded
    Vec3 camera = {0, 0, 0};         ///< [m]
    Vec3 margin = {0, 0, 0};         ///< maximum displacement by waves [m]
    Frustum frustum;                 ///< view frustum
    float finest = 1;                ///< minimum side to subdivide, > 0 [m]
    float detail = kMinPatchDetail;  ///< ratio of distance to patch side, >= 2
    float body = 0;
};

[[nodiscard]] inline float slope_variance(const WaveLine& line) {
    return 0.5f * square(line.amplitude) * glm::dot(line.k, line.k);
}

/// Sets the lines of patches by the distance of their vertices; `lines`: longest first. The rule is
/// resolved_fraction() of lib/water_surface.glsl: those left out would be multiplied by 0.
void resolve_lines(std::span<const WaveLine> lines, std::span<WaterPatch> patches);

/// Appends the patches that may be visible, none before one that may hide it from the camera, at
/// most kMaxWaterPatches in total; beyond that the last ones are too large or missing.
void append_water_patches(const PatchSource& source, std::vector<WaterPatch>& patches);

}  // namespace limn
