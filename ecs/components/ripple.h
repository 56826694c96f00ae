#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

// Effects that refract light on its way to the camera, so that the image behind them is distorted.
// Objects in front of them are unaffected.
// Techniques: post.scene-ripple

/// A shock wave: a shell that expands about the entity's position. `update_ripples` advances its
/// age and removes it when it has ended.
struct RippleRing {
    float age = 0;
    float duration = 1.2f;
    float period = 0;
    float speed = 8.0f;
    float wavelength = 0.8f;
    float amplitude = 0.02f;
    float start_radius = 0.0f;
};

LIMN_FIELDS(RippleRing) {
    LIMN_FIELD(age, "time since its start; negative: starts later", "s");
    LIMN_FIELD(duration, "duration", "s", 0.01);
    LIMN_FIELD(period, "time from start to restart; 0 = once", "s", 0);
    LIMN_FIELD(speed, "expansion speed of the shell", "m/s", 0);
    LIMN_FIELD(wavelength, "half the thickness of the shell", "m", 1e-3);
    LIMN_FIELD(amplitude, "initial peak deflection of a ray", "rad", -0.5, 0.5);
    LIMN_FIELD(start_radius, "radius at age 0", "m", 0);
}

enum class HazeShape : std::uint8_t { Box, Ball };

/// Rising hot air in a region: the box or ball of half-extent 1 in the entity's local space.
struct HeatHaze {
    HazeShape shape = HazeShape::Box;
    float strength = 0.01f;
    float scale = 0.25f;
    float rise = 1.2f;
    std::uint32_t seed = 1;
};

LIMN_FIELDS(HeatHaze) {
    LIMN_FIELD(
        shape, .doc = "region of half-extent 1 in the entity's local space", .values = "box ball");
    LIMN_FIELD(strength, "largest distortion, as a fraction of the image height", "", 0, 0.2);
    LIMN_FIELD(scale, "size of an eddy", "m", 1e-3);
    LIMN_FIELD(rise, "upward speed of the air", "m/s", -100, 100);
    LIMN_FIELD(seed, "random seed of the eddies");
}

/// Resource: rain drops on the lens, in front of the whole scene. A function of time and seed only.
struct LensRain {
    float amount = 0.5f;
    float size = 0.08f;
    float speed = 0.25f;
    float strength = 1.0f;
    std::uint32_t seed = 1;
};

LIMN_FIELDS(LensRain) {
    LIMN_FIELD(amount, "fraction of drop cells that are wet", "", 0, 1);
    LIMN_FIELD(size, "size of a large drop, as a fraction of the image height", "", 0.005, 0.5);
    LIMN_FIELD(speed, "speed of drops running down", "heights/s", 0, 10);
    LIMN_FIELD(strength, "strength of the refraction", "", 0, 4);
    LIMN_FIELD(seed, "random seed of positions and times");
}

/// Full-screen distortion as if space were a disturbed viscous fluid (post.scene-ripple): no depth,
/// no perspective. Radius and amplitude over time are those of the spec.
struct ScreenRipple {
    Vec2 center = {0.5f, 0.5f};
    float age = 0;
    float duration = 0.5f;
    float amplitude = 0.05f;
    float radius = 0.05f;
    float radius_speed = 2.0f;
    bool round = false;
    int grid = 0;
};

LIMN_FIELDS(ScreenRipple) {
    LIMN_FIELD(center, "center in image fractions from the lower left");
    LIMN_FIELD(age, "time since its start; negative: starts later", "s");
    LIMN_FIELD(duration, "duration", "s", 0.01);
    LIMN_FIELD(amplitude, "largest distortion, as a fraction of the image", "", -1, 1);
    LIMN_FIELD(radius, "radius at age 0, as a fraction of the image", "", 0);
    LIMN_FIELD(radius_speed, "growth of the radius", "1/s");
    LIMN_FIELD(round, "circular in pixels; otherwise an ellipse");
    LIMN_FIELD(
        grid, "evaluated on a grid with this many points per side; 0 = per pixel", "", 0, 1024);
}

/// Fraction of the peak amplitude at the current age: half a sine.
[[nodiscard]] inline float ripple_fade(const ScreenRipple& ripple) {
    const bool on = ripple.duration > 0 && ripple.age > 0 && ripple.age < ripple.duration;
    return on ? std::sin(kPi * ripple.age / ripple.duration) : 0.0f;
}
/// The same for a ring: starts at 1 and decays linearly.
[[nodiscard]] inline float ripple_fade(const RippleRing& ring) {
    const bool on = ring.duration > 0 && ring.age > 0 && ring.age < ring.duration;
    return on ? 1.0f - ring.age / ring.duration : 0.0f;
}

}  // namespace limn
