#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// Closed-form waves on a body of water: a few, set by hand or at random. Crests are straight lines
// or circles; apart from orbital motion the water itself does not move. Directions are angles from
// the water's +x toward its +z.
// Techniques: water.gerstner, water.radial-packet, water.radial-wave, water.travelling-wave,
//     water.trochoid, water.wave-sum, water.wind-crest

/// An unbounded traveling wave with straight crests (water.travelling-wave); with `sharpness` a
/// trochoid (water.gerstner), with `lean` tilted forward by the wind (water.wind-crest).
struct WaterWave {
    float amplitude = 0.1f;
    float length = 8.0f;
    float direction = 0;
    float phase = 0;
    float sharpness = 0;  ///< Q: 0 sine, 1 circular orbits; limited so that crests do not loop
    float lean = 0;
};

LIMN_FIELDS(WaterWave) {
    LIMN_FIELD(amplitude, "half the crest-to-trough height", "m", 0, 100);
    LIMN_FIELD(length, "wavelength, crest to crest", "m", 0.001, 1e5);
    LIMN_FIELD(direction, "direction of travel, from +x toward +z", "rad");
    LIMN_FIELD(phase, "phase at time 0", "rad");
    LIMN_FIELD(sharpness, "0 sine, 1 circular orbits (trochoid)", "", 0, 100);
    LIMN_FIELD(lean, "forward lean of crests", "", 0, 0.99);
}

/// Random waves, uniformly distributed within these ranges (water.wave-sum).
struct WaveGroup {
    std::uint32_t count = 4;
    Vec2 length = {8, 30};
    Vec2 amplitude = {0.05f, 0.25f};
    float direction = 0;
    float spread = 0.52f;
    float sharpness = 0;
    std::uint32_t seed = 1;
};

LIMN_FIELDS(WaveGroup) {
    LIMN_FIELD(count, "number of waves", "", 0, 256);
    LIMN_FIELD(length, "wavelength: minimum and maximum", "m", 0.001, 1e5);
    LIMN_FIELD(amplitude, "amplitude: minimum and maximum", "m", 0, 100);
    LIMN_FIELD(direction, "mean direction of travel, from +x toward +z", "rad");
    LIMN_FIELD(spread, "largest deviation from the mean direction", "rad", 0, 3.15);
    LIMN_FIELD(sharpness, "sharpness of each wave", "", 0, 100);
    LIMN_FIELD(seed, "random seed");
}

/// Circular wave about a point (water.radial-wave).
struct RadialWave {
    Vec2 center = {0, 0};
    float amplitude = 0.1f;
    float length = 4.0f;
    float phase = 0;
    bool inward = false;
    float fade_radius = 0;
};

LIMN_FIELDS(RadialWave) {
    LIMN_FIELD(center, "center, x and z in the water's local space", "m");
    LIMN_FIELD(amplitude, "half the crest-to-trough height", "m", 0, 100);
    LIMN_FIELD(length, "wavelength, crest to crest", "m", 0.001, 1e5);
    LIMN_FIELD(phase, "phase at time 0", "rad");
    LIMN_FIELD(inward, "travels toward the center");
    LIMN_FIELD(
        fade_radius, .doc = "radius beyond which it fades; 0: never", .unit = "m", .min = 0,
        .max = 1e5, .renamed = "full");
}

/// A ring of a few waves that travels outward, as from a drop (water.radial-packet).
struct WavePacket {
    Vec2 center = {0, 0};
    float age = 0;
    float amplitude = 0.02f;
    float length = 0.2f;
    std::uint32_t waves = 3;
    float lifetime = 2.0f;
    float decay = 1.0f;
    bool smooth = true;
};

LIMN_FIELDS(WavePacket) {
    LIMN_FIELD(center, "center, x and z in the water's local space", "m");
    LIMN_FIELD(age, "time since its start; negative: starts later", "s");
    LIMN_FIELD(amplitude, "half the crest-to-trough height", "m", 0, 100);
    LIMN_FIELD(length, "wavelength", "m", 0.001, 1e5);
    LIMN_FIELD(waves, "number of waves in the ring", "", 1, 1000);
    LIMN_FIELD(lifetime, "age at which it ends", "s", 0, 1e5);
    LIMN_FIELD(decay, "time constant of its exponential decay; 0: no decay", "s", 0, 1e5);
    LIMN_FIELD(smooth, "sin^2 envelope across the ring");
}

/// With a Water: its closed-form waves.
struct WaterWaves {
    std::vector<WaterWave> waves{};
    std::vector<WaveGroup> groups{};
    std::vector<RadialWave> radial{};
    std::vector<WavePacket> packets{};  ///< removed once expired
};

LIMN_FIELDS(WaterWaves) {
    LIMN_FIELD(waves, "waves with straight crests");
    LIMN_FIELD(groups, "random waves within ranges");
    LIMN_FIELD(radial, "circular waves about a point");
    LIMN_FIELD(packets, "short-lived rings that travel outward");
}

/// A wave with straight crests.
struct WaveLine {
    Vec2 k = {0, 0};      ///< wave vector [rad/m]
    Vec2 side = {0, 0};   ///< B d [m]
    float phase = 0;      ///< at the water's local origin, -pi .. pi [rad]
    float amplitude = 0;  ///< [m]
    float lean = 0;
    float frequency = 0;  ///< omega [rad/s]
};

/// A circular wave, 0 outside the radii first .. last.
struct WaveRing {
    Vec2 center = {0, 0};   ///< [m]
    float k = 0;            ///< [rad/m]
    float phase = 0;        ///< at the center [rad]
    float amplitude = 0;    ///< [m]
    float frequency = 0;    ///< d phase / dt [rad/s]; negative: travels outward
    float fade_radius = 0;  ///< radius beyond which it fades as 1 / sqrt(r) [m]; 0: never fades
    float first = 0;        ///< inner radius [m]
    float last = 0;         ///< outer radius [m]
    float front_speed = 0;  ///< of both radii [m/s]
    bool smooth = false;    ///< sin^2 envelope from first to last
};

/// With WaterWaves, rebuilt each step: its waves at the current time, ready for evaluation at any
/// point. The displacement is the sum of
///     vertical    A sin(p),  p = phase - lean max(0, sin(phase))
///     horizontal  B d cos(phase)                      (toward crests, B >= 0)
/// with phase = k.x + phase(t) and d = k / |k|.
struct WaveTable {
    std::vector<WaveLine> lines{};  ///< longest first
    std::vector<WaveRing> rings{};
};

/// Derived from WaterWaves and the time.
template <>
struct ComponentTraits<WaveTable> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
};

}  // namespace limn
