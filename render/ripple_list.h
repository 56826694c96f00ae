#pragma once

#include "ecs/components/ripple.h"

#include <vector>

namespace limn {

class World;
struct RenderView;

// Everything that ripples at the moment a view shows, ready to be drawn.

/// Where in the picture: x and y of the lower left and the upper right corner, -1 .. 1.
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
    float distance = 0;  ///< of its middle, along the view axis [m]
    Mat4 local_from_world{1.0f};
    HazeShape shape = HazeShape::Box;
    float shift = 0;   ///< largest [px]
    float scale = 1;   ///< [m]
    float raised = 0;  ///< how far the air has risen [eddies]
    std::uint32_t seed = 0;
};

struct ScreenRecord {
    Vec2 center{0};
    float radius = 0;
    float amplitude = 0;
    float aspect = 1;  ///< by which distances along x count
    int grid = 0;
};

struct RainRecord {
    LensRain rain{.amount = 0};
    float time = 0;  ///< [s]
};

struct RippleList {
    std::vector<RingRecord> rings;  ///< the nearest first
    std::vector<HazeRecord> hazes;  ///< the nearest first
    std::vector<ScreenRecord> screens;
    RainRecord rain;

    [[nodiscard]] bool empty() const {
        return rings.empty() && hazes.empty() && screens.empty() && rain.rain.amount <= 0;
    }
};

/// Leaves out what would not change the picture.
[[nodiscard]] RippleList collect_ripples(const World& world, const RenderView& view);

}  // namespace limn
