#pragma once

#include "ecs/components/ocean.h"
#include "ecs/components/transform.h"
#include "ecs/components/water.h"
#include "ecs/components/water_frame.h"
#include "ecs/components/water_ripples.h"
#include "ecs/components/water_waves.h"
#include "ecs/query.h"
#include "systems/water/water_wave_table.h"

#include <optional>
#include <span>
#include <vector>

namespace limn {

// Surface queries: used by everything that floats, hits or looks at water.
//
// Ocean, waves and ripples displace the rest point q to P(q) = q + D(q), which is also what is
// drawn. A query is for a displaced position, so q + D_xz(q) = (x, z) is solved for q by Newton's
// method with backtracking: two to five evaluations for mild waves, more near cusps, where the
// derivative vanishes. Where crests fold over there are several solutions, of which it finds one.

/// A body of water at the current time: its frame, and its displacements or nullptr.
struct WaterSurface {
    WaterFrame frame{};
    Water water{};
    const OceanState* ocean = nullptr;
    const WaveTable* waves = nullptr;
    const RippleState* ripples = nullptr;
    float min_wavelength =
        0;  ///< shorter waves are ignored, for objects that are large compared to them [m]
    Entity entity{};
};

/// All bodies of water, as a parameter of systems.
using WaterQuery = Query<
    const Water, const WorldTransform, Optional<const OceanState>, Optional<const WaveTable>,
    Optional<const RippleState>>;

[[nodiscard]] std::vector<WaterSurface> collect_water_surfaces(WaterQuery waters);

struct WaterPoint {
    bool is_water = false;      ///< whether there is water; if not, the other fields are invalid
    Vec3 position = {0, 0, 0};  ///< of the surface, world space [m]
    Vec3 normal = {0, 1, 0};    ///< unit, up
    Vec3 velocity = {0, 0, 0};  ///< of the water there [m/s]
    Vec2 rest = {0, 0};         ///< rest position, in the water's local space [m]
    float error = 0;            ///< horizontal distance between `position` and the query [m]
    int evaluations = 0;        ///< number of evaluations of the displacement

    /// Derivatives of the height by world x and z; limited at cusps.
    [[nodiscard]] Vec2 slope() const {
        const float up = std::max(normal.y, 0.05f);
        return {-normal.x / up, -normal.z / up};
    }
};

/// Total displacement of the rest point `rest`, in the water's local space.
[[nodiscard]] WavePoint displace_water(const WaterSurface& surface, const Vec2& rest);

/// The surface above or below world (x, z). No water if `at` is not finite.
[[nodiscard]] WaterPoint sample_water(const WaterSurface& surface, const Vec2& at);

/// The same for many points, on all threads. Both spans have the same length.
void sample_waters(
    const WaterSurface& surface, std::span<const Vec2> at, std::span<WaterPoint> points);

/// World height of the bottom [m]; -infinity if the water is infinitely deep.
[[nodiscard]] float water_bottom(const WaterSurface& surface);

/// The body of water that contains a point.
struct WaterAround {
    std::size_t index = 0;  ///< in the list of surfaces
    float depth = 0;        ///< vertical distance of the point below the surface [m]
    WaterPoint surface{};
};

/// The body of water that contains `point`, between surface and bottom; of several, the one with
/// the nearest surface.
[[nodiscard]] std::optional<WaterAround>
find_water(std::span<const WaterSurface> surfaces, const Vec3& point);

/// First intersection of a ray with the surface from above, within `max_distance` [m]. `direction`
/// is unit. A grazing ray may miss the first crest of high waves.
[[nodiscard]] std::optional<WaterPoint> hit_water(
    const WaterSurface& surface, const Vec3& origin, const Vec3& direction, float max_distance);

}  // namespace limn
