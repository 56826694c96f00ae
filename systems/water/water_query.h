#pragma once

#include "ecs/components/ocean.h"
#include "ecs/components/water.h"
#include "ecs/components/water_frame.h"
#include "ecs/components/water_ripples.h"
#include "ecs/components/water_waves.h"
#include "systems/water/water_wave_table.h"

#include <optional>
#include <span>

namespace limn {

// What the water does at a place: the one query of all that floats, falls in or looks.
//
// Ocean, waves and ripples displace the point at rest at q to P(q) = q + D(q), which is also what
// is drawn. Who asks knows where he is, not what rests below him, so q + D_xz(q) = (x, z) is solved
// for q by Newton's method with backtracking: two to five evaluations where waves are mild, more
// near cusps, where the derivative vanishes. Where crests fold over there are several q, and it
// finds one of them.

/// A body of water at one moment: where it lies, and what moves it or nullptr.
struct WaterSurface {
    WaterFrame frame{};
    Water water{};
    const OceanState* ocean = nullptr;
    const WaveTable* waves = nullptr;
    const RippleState* ripples = nullptr;
    float shortest =
        0;  ///< waves shorter than this are left out, for what is too large for them [m]
};

struct WaterPoint {
    bool is_water = false;      ///< whether there is any; if not, the rest says nothing
    Vec3 position = {0, 0, 0};  ///< of the surface, in the world [m]
    Vec3 normal = {0, 1, 0};    ///< unit, up
    Vec3 velocity = {0, 0, 0};  ///< of the water that is there now [m/s]
    Vec2 rest = {0, 0};         ///< where it is at rest, in the water's own space [m]
    float miss = 0;             ///< how far `position` is from the place asked for, aside [m]
    int evaluations = 0;        ///< of the displacement, that it took

    /// Height by x and by z of the world; not infinite where a crest is a cusp.
    [[nodiscard]] Vec2 slope() const {
        const float up = std::max(normal.y, 0.05f);
        return {-normal.x / up, -normal.z / up};
    }
};

/// The displacement of the water at rest at `rest`, in its own space, by all that moves it.
[[nodiscard]] WavePoint displace_water(const WaterSurface& surface, const Vec2& rest);

/// The surface above or below (x, z) of the world. A place that is not finite has no water.
[[nodiscard]] WaterPoint sample_water(const WaterSurface& surface, const Vec2& at);

/// The same at many places, on all threads. Both spans have one length.
void sample_waters(
    const WaterSurface& surface, std::span<const Vec2> at, std::span<WaterPoint> points);

/// Height of the bottom in the world [m]; minus infinity where the water is deep.
[[nodiscard]] float water_bottom(const WaterSurface& surface);

/// The water that a point is in.
struct WaterAround {
    std::size_t index = 0;  ///< among those asked
    float depth = 0;        ///< of the point below the surface, straight up [m]
    WaterPoint surface{};
};

/// Of several waters that `point` is in - below the surface, above the bottom - the one with the
/// nearest surface.
[[nodiscard]] std::optional<WaterAround>
find_water(std::span<const WaterSurface> surfaces, const Vec3& point);

/// Where a ray first meets the surface from above, if it does so within `reach` [m]. `direction` is
/// unit. A ray that grazes high waves may go through the first crest.
[[nodiscard]] std::optional<WaterPoint>
hit_water(const WaterSurface& surface, const Vec3& origin, const Vec3& direction, float reach);

}  // namespace limn
