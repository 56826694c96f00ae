#pragma once

#include "ecs/components/ripple.h"
#include "render/effect.h"

#include <vector>

namespace limn {

// Ripples: screen-space distortion behind shock waves, hot air and raindrops (post.scene-ripple,
// post.glare-heat-haze).
//
// Every ripple adds to a field of offsets [px]; one pass then reads the radiance at the offset
// positions. Surfaces in front of a ripple are neither distorted nor sampled: of the four bilinear
// texels those in front are rejected, and where none is left the pixel is unchanged. So the
// foreground neither ripples nor leaks into the rippled background, bit-exactly.
//
//     ring   rays turn away from the shell's center by a sin(2 pi s) (1 - s^2)^2, s = (b - r) / l,
//            b the ray's minimum distance to the center; times the fraction of the distance to
//            the visible surface that lies behind the shell
//     haze   two gradient noises at the midpoint of the ray's path through the region, times the
//            visible fraction of that path and the distance to the region's border
//     rain   drops in cells that invert the image, some of which run down (by eye)
//     screen post.scene-ripple as specified
//
// Reads    radiance, depth
// Writes   radiance; the field, "ripple.field"
// Order    after everything visible through it, before motion blur
// Shaders  ripple_quad.vert with ripple_ring.frag, ripple_haze.frag, ripple_rain.frag,
//          ripple_screen.frag; ripple_grid.vert, .frag; ripple_resolve.frag
//
// Depth and velocity are not distorted: later passes attribute a shifted pixel to the surface at
// that position. Both surfaces are behind the ripple, so the foreground keeps its outline.

/// Screen rectangle: x and y of the lower left and of the upper right corner, -1 .. 1.
using NdcRect = Vec4;

struct RingRecord {
    NdcRect rect;
    float distance = 0;    ///< along the view axis [m]
    Vec3 center{0};        ///< [m]
    float radius = 0;      ///< [m]
    float wavelength = 1;  ///< [m]
    float amplitude = 0;   ///< [rad]
};

struct HazeRecord {
    NdcRect rect;
    float distance = 0;  ///< of its center, along the view axis [m]
    Mat4 local_from_world{1.0f};
    HazeShape shape = HazeShape::Box;
    float shift = 0;   ///< maximum [px]
    float scale = 1;   ///< [m]
    float raised = 0;  ///< rise of the air so far [eddies]
    std::uint32_t seed = 0;
};

struct ScreenRecord {
    Vec2 center{0};
    float radius = 0;
    float amplitude = 0;
    float aspect = 1;  ///< scale of distances along x
    int grid = 0;
};

struct RainRecord {
    LensRain rain{.amount = 0};
    float time = 0;  ///< [s]
};

/// All ripples at the time a view shows.
struct RippleList {
    std::vector<RingRecord> rings;  ///< nearest first
    std::vector<HazeRecord> hazes;  ///< nearest first
    std::vector<ScreenRecord> screens;
    RainRecord rain;

    [[nodiscard]] bool empty() const {
        return rings.empty() && hazes.empty() && screens.empty() && rain.rain.amount <= 0;
    }
};

struct RippleEffect {
    const gpu::Program* ring = nullptr;
    const gpu::Program* haze = nullptr;
    const gpu::Program* rain = nullptr;
    const gpu::Program* screen = nullptr;
    const gpu::Program* grid = nullptr;
    const gpu::Program* resolve = nullptr;
    RippleList ripples = {};  ///< of the frame

    static Result<RippleEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    bool prepare(const FrameData& frame, ViewData& view);
    void draw(FrameGraph& graph, const FrameData&, ViewData& view);
};

}  // namespace limn
