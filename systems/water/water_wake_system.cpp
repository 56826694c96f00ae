#include "systems/water/water_wake_system.h"

#include "ecs/components/water_frame.h"
#include "systems/water/water_dispersion.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace limn {

namespace {

constexpr float kAbove = 3.0f;           ///< above or below the water at rest, at most [m]
constexpr float kJump = 100.0f;          ///< speed beyond which it has jumped [m/s]
constexpr float kLeastSpeed = 0.2f;      ///< below which there is no wake [m/s]
constexpr float kLifetime = 3.0f;        ///< of a ring, in decays
constexpr std::size_t kMostRings = 256;  ///< of a water
constexpr int kMostAStep = 16;

/// A ring that began at `at` of the world some time ago.
void add_ring(
    const WakeEmitter& wake, const Vec2& at, float speed, float age,
    Query<const Water, const WorldTransform, WaterWaves> waters, float height) {
    waters.each([&](const Water& water, const WorldTransform& place, WaterWaves& waves) {
        const WaterFrame frame = water_frame(place.world);
        const Vec3 local = frame.local({at.x, height, at.y});
        if (!is_inside(water, {local.x, local.z}) || std::abs(local.y) > kAbove
            || waves.packets.size() >= kMostRings) {
            return;
        }
        waves.packets.push_back(
            {.center = {local.x, local.z},
             .age = age,
             .amplitude = wake.amplitude,
             .length = wake.length > 0 ? wake.length : kelvin_length(speed),
             .waves = wake.waves,
             .lifetime = kLifetime * wake.decay,
             .decay = wake.decay});
    });
}

}  // namespace

float kelvin_length(float speed) {
    return 2 * kPi * square(speed / 3) / static_cast<float>(kGravity);
}

void emit_wakes(
    Query<WakeEmitter, const WorldTransform> emitters,
    Query<const Water, const WorldTransform, WaterWaves> waters, Res<const FrameTime> time) {
    emitters.each([&](WakeEmitter& wake, const WorldTransform& place) {
        const Affine& world = place.world;
        const Vec2 now = {world.row[0].w, world.row[2].w};
        const Vec2 before = std::exchange(wake.before, now);
        const float speed = glm::distance(now, before) / time->step;
        if (!wake.started || !(speed < kJump) || !(wake.spacing > 0)) {
            wake.started = std::isfinite(now.x + now.y);
            wake.last = now;
            return;
        }
        if (speed < kLeastSpeed) {
            return;
        }
        // One where each `spacing` was full, as old as it is since.
        for (int i = 0; i < kMostAStep && glm::distance(now, wake.last) >= wake.spacing; ++i) {
            wake.last += glm::normalize(now - wake.last) * wake.spacing;
            const float age = glm::distance(now, wake.last) / speed;
            add_ring(wake, wake.last, speed, age, waters, world.row[1].w);
        }
    });
}

}  // namespace limn
