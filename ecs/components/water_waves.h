#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// Waves of closed form on a body of water: few, chosen by hand or at random. Crests are lines or
// circles; the water itself stays where it is but for orbits. Directions are angles from the
// water's +x toward its +z.

/// A line of crests that runs on for ever (water.travelling-wave); with `sharpness` a trochoid
/// (water.gerstner), with `lean` pushed over by the wind (water.wind-crest).
struct WaterWave {
    float amplitude = 0.1f;  ///< half the height from trough to crest [m]
    float length = 8.0f;     ///< [m], > 0
    float direction = 0;     ///< in which it runs [rad]
    float phase = 0;         ///< [rad]
    float sharpness = 0;     ///< Q: 0 a sine, 1 water goes in circles; never more than makes cusps
    float lean = 0;          ///< 0: upright; below 1
};

/// Waves drawn at random within bounds, all alike likely (water.wave-sum).
struct WaveGroup {
    std::uint32_t count = 4;
    Vec2 length = {8, 30};            ///< least and largest [m]
    Vec2 amplitude = {0.05f, 0.25f};  ///< [m]
    float direction = 0;              ///< in which they run in the mean [rad]
    float spread = 0.52f;             ///< to both sides of it [rad]
    float sharpness = 0;              ///< of each
    std::uint32_t seed = 1;
};

/// Circles about a point (water.radial-wave).
struct RadialWave {
    Vec2 center = {0, 0};    ///< x and z in the water's own space [m]
    float amplitude = 0.1f;  ///< [m]
    float length = 4.0f;     ///< [m], > 0
    float phase = 0;         ///< [rad]
    bool inward = false;     ///< runs toward the center
    float full = 0;          ///< fades with 1 / sqrt(r) from there on [m]; 0: nowhere
};

/// A ring of a few waves that runs outward, as of a drop (water.radial-packet).
struct WavePacket {
    Vec2 center = {0, 0};     ///< x and z in the water's own space [m]
    float age = 0;            ///< since it began [s]; negative: begins later
    float amplitude = 0.02f;  ///< [m]
    float length = 0.2f;      ///< of a wave [m], > 0
    std::uint32_t waves = 3;  ///< in the ring
    float lifetime = 2.0f;    ///< [s]
    float decay = 1.0f;       ///< fades by exp(-age / decay) [s]; 0: never
    bool smooth = true;       ///< fades to both edges of the ring by sin^2
};

/// Beside a Water.
struct WaterWaves {
    std::vector<WaterWave> waves{};
    std::vector<WaveGroup> groups{};
    std::vector<RadialWave> radial{};
    std::vector<WavePacket> packets{};  ///< those that have ended are taken away
};

/// A line of crests.
struct WaveLine {
    Vec2 k = {0, 0};      ///< wave vector [rad/m]
    Vec2 side = {0, 0};   ///< B d [m]
    float phase = 0;      ///< at the water's origin, -pi .. pi [rad]
    float amplitude = 0;  ///< [m]
    float lean = 0;
    float frequency = 0;  ///< omega [rad/s]
};

/// Circles; outside first .. last there are none.
struct WaveRing {
    Vec2 center = {0, 0};   ///< [m]
    float k = 0;            ///< [rad/m]
    float phase = 0;        ///< at the center [rad]
    float amplitude = 0;    ///< [m]
    float frequency = 0;    ///< d phase / dt [rad/s]; negative: runs outward
    float full = 0;         ///< fades with 1 / sqrt(r) from there on [m]; 0: nowhere
    float first = 0;        ///< radius [m]
    float last = 0;         ///< [m]
    float front_speed = 0;  ///< of first and last [m/s]
    bool smooth = false;    ///< fades to both by sin^2
};

/// Beside WaterWaves, made anew each step: its waves at this moment, ready to be asked what they do
/// at a point. That is the sum of
///     height     A sin(p),  p = phase - lean max(0, sin(phase))
///     sideways   B d cos(phase)                      (toward crests, B >= 0)
/// with phase = k.x + phase(t) and d = k / |k|.
struct WaveTable {
    std::vector<WaveLine> lines{};  ///< longest first
    std::vector<WaveRing> rings{};
};

/// Follows from WaterWaves and the time.
template <>
struct ComponentTraits<WaveTable> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
};

template <typename Visitor>
void visit_fields(WaterWave& wave, Visitor&& visit) {
    visit(
        "amplitude", wave.amplitude, {.doc = "half the height", .unit = "m", .min = 0, .max = 100});
    visit(
        "length", wave.length,
        {.doc = "from crest to crest", .unit = "m", .min = 0.001, .max = 1e5});
    visit(
        "direction", wave.direction, {.doc = "in which it runs, from +x toward +z", .unit = "rad"});
    visit("phase", wave.phase, {.doc = "where it begins", .unit = "rad"});
    visit(
        "sharpness", wave.sharpness,
        {.doc = "0 a sine, 1 water goes in circles", .min = 0, .max = 100});
    visit("lean", wave.lean, {.doc = "how far crests lean forward", .min = 0, .max = 0.99});
}

template <typename Visitor>
void visit_fields(WaveGroup& group, Visitor&& visit) {
    visit("count", group.count, {.doc = "how many", .min = 0, .max = 256});
    visit(
        "length", group.length,
        {.doc = "least and largest", .unit = "m", .min = 0.001, .max = 1e5});
    visit(
        "amplitude", group.amplitude,
        {.doc = "least and largest", .unit = "m", .min = 0, .max = 100});
    visit("direction", group.direction, {.doc = "in which they run in the mean", .unit = "rad"});
    visit(
        "spread", group.spread,
        {.doc = "to both sides of it", .unit = "rad", .min = 0, .max = 3.15});
    visit("sharpness", group.sharpness, {.doc = "of each", .min = 0, .max = 100});
    visit("seed", group.seed, {.doc = "other waves within the same bounds"});
}

template <typename Visitor>
void visit_fields(RadialWave& wave, Visitor&& visit) {
    visit("center", wave.center, {.doc = "x and z in the water's own space", .unit = "m"});
    visit(
        "amplitude", wave.amplitude, {.doc = "half the height", .unit = "m", .min = 0, .max = 100});
    visit(
        "length", wave.length,
        {.doc = "from crest to crest", .unit = "m", .min = 0.001, .max = 1e5});
    visit("phase", wave.phase, {.doc = "where it begins", .unit = "rad"});
    visit("inward", wave.inward, {.doc = "runs toward the center"});
    visit(
        "full", wave.full, {.doc = "fades beyond; 0: nowhere", .unit = "m", .min = 0, .max = 1e5});
}

template <typename Visitor>
void visit_fields(WavePacket& packet, Visitor&& visit) {
    visit("center", packet.center, {.doc = "x and z in the water's own space", .unit = "m"});
    visit("age", packet.age, {.doc = "since it began; negative: begins later", .unit = "s"});
    visit(
        "amplitude", packet.amplitude,
        {.doc = "half the height", .unit = "m", .min = 0, .max = 100});
    visit("length", packet.length, {.doc = "of a wave", .unit = "m", .min = 0.001, .max = 1e5});
    visit("waves", packet.waves, {.doc = "in the ring", .min = 1, .max = 1000});
    visit("lifetime", packet.lifetime, {.doc = "when it ends", .unit = "s", .min = 0, .max = 1e5});
    visit(
        "decay", packet.decay,
        {.doc = "fades to 1/e in it; 0: never", .unit = "s", .min = 0, .max = 1e5});
    visit("smooth", packet.smooth, {.doc = "fades to both edges of the ring"});
}

template <typename Visitor>
void visit_fields(WaterWaves& waves, Visitor&& visit) {
    visit("waves", waves.waves, {.doc = "lines of crests"});
    visit("groups", waves.groups, {.doc = "waves at random within bounds"});
    visit("radial", waves.radial, {.doc = "circles about a point"});
    visit("packets", waves.packets, {.doc = "rings that run outward and end"});
}

}  // namespace limn
