#include "systems/water/water_wake_system.h"

#include "ecs/components/water_frame.h"
#include "systems/water/water_dispersion.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

// Techniques: water.wake

namespace limn {

namespace {

constexpr float kAbove = 3.0f;          ///< largest distance above or below the rest surface [m]
constexpr float kJump = 100.0f;         ///< speed above which motion counts as a teleport [m/s]
constexpr float kMinWakeSpeed = 0.2f;   ///< below which there is no wake [m/s]
constexpr float kLifetime = 3.0f;       ///< of a ring, in time constants of its decay
constexpr std::size_t kMaxRings = 256;  ///< per body of water
constexpr int kMaxRingsPerStep = 16;

/// Adds a ring of this age at `at` in the world.
void add_wake_ring(
    const WakeEmitter& wake, const Vec2& at, float speed, float age,
    Query<const Water, const WorldTransform, WaterWaves> waters, float height) {
    waters.each([&](const Water& water, const WorldTransform& transform, WaterWaves& waves) {
        const WaterFrame frame = water_frame(transform.world);
        const Vec3 local = frame.local({at.x, height, at.y});
        if (!is_inside(water, {local.x, local.z}) || std::abs(local.y) > kAbove
            || waves.packets.size() >= kMaxRings) {
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

void add_wake_states(Query<const WakeEmitter, Without<WakeState>> emitters, Commands commands) {
    emitters.each([&](Entity entity, const WakeEmitter&) { commands.add(entity, WakeState{}); });
}

void emit_wakes(
    Query<const WakeEmitter, WakeState, const WorldTransform> emitters,
    Query<const Water, const WorldTransform, WaterWaves> waters, Res<const FrameTime> time) {
    emitters.each([&](const WakeEmitter& wake, WakeState& state, const WorldTransform& transform) {
        const Affine& world = transform.world;
        const Vec2 now = {world.row[0].w, world.row[2].w};
        const Vec2 before = std::exchange(state.previous, now);
        const float speed = glm::distance(now, before) / time->step;
        if (!state.started || !(speed < kJump) || !(wake.spacing > 0)) {
            state.started = std::isfinite(now.x + now.y);
            state.last_ring = now;
            return;
        }
        if (speed < kMinWakeSpeed) {
            return;
        }
        // One ring per `spacing` traveled, with the time since then as its age.
        for (int i = 0; i < kMaxRingsPerStep && glm::distance(now, state.last_ring) >= wake.spacing;
             ++i) {
            state.last_ring += glm::normalize(now - state.last_ring) * wake.spacing;
            const float age = glm::distance(now, state.last_ring) / speed;
            add_wake_ring(wake, state.last_ring, speed, age, waters, world.row[1].w);
        }
    });
}

}  // namespace limn
