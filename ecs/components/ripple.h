#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

// What bends light on its way to the camera, so that the picture behind it ripples. What stands in
// front stays as it is.

/// A shock wave: a shell that grows about the entity's place. `update_ripples` advances its age and
/// takes it away when it has ended.
struct RippleRing {
    float age = 0;              ///< since it began [s]; negative: begins later
    float duration = 1.2f;      ///< [s], > 0
    float period = 0;           ///< begins anew so long after it began [s]; 0 = once
    float speed = 8.0f;         ///< of the shell [m/s], >= 0
    float wavelength = 0.8f;    ///< half the thickness of the shell [m], > 0
    float amplitude = 0.02f;    ///< largest turn of a ray, at first [rad]
    float start_radius = 0.0f;  ///< at age 0 [m], >= 0
};

enum class HazeShape : std::uint8_t { Box, Ball };

/// Hot air that rises in a region: the box or ball of half-extent 1 in the entity's own space.
struct HeatHaze {
    HazeShape shape = HazeShape::Box;
    float strength = 0.01f;  ///< largest shift, as a share of the picture's height, 0 .. 0.2
    float scale = 0.25f;     ///< size of an eddy [m], > 0
    float rise = 1.2f;       ///< of the air, up [m/s]
    std::uint32_t seed = 1;
};

/// Resource: rain on the lens, before everything. A function of time and seed alone.
struct LensRain {
    float amount = 0.5f;    ///< share of the places for drops that are wet, 0 .. 1; 0 = dry
    float size = 0.08f;     ///< of a large drop, as a share of the picture's height
    float speed = 0.25f;    ///< at which drops run down [picture heights/s]
    float strength = 1.0f;  ///< of the refraction, 0 .. 4
    std::uint32_t seed = 1;
};

/// The whole picture as if space were a disturbed viscous fluid (post.scene-ripple): no depth, no
/// perspective. Radius and amplitude over time are the spec's.
struct ScreenRipple {
    Vec2 center = {0.5f, 0.5f};  ///< share of the picture from the left and from below
    float age = 0;               ///< since it began [s]; negative: begins later
    float duration = 0.5f;       ///< [s], > 0
    float amplitude = 0.05f;     ///< largest shift, as a share of the picture
    float radius = 0.05f;        ///< at age 0, as a share of the picture
    float radius_speed = 2.0f;   ///< [shares/s]
    bool round = false;          ///< in pixels; otherwise in shares, an ellipse
    int grid = 0;                ///< computed at a grid of so many points a side; 0 = every pixel
};

/// Share of its largest amplitude at this age: comes and goes as half a sine.
[[nodiscard]] inline float ripple_fade(const ScreenRipple& ripple) {
    const bool on = ripple.duration > 0 && ripple.age > 0 && ripple.age < ripple.duration;
    return on ? std::sin(kPi * ripple.age / ripple.duration) : 0.0f;
}
/// The same of a ring, which is sudden and then dies out.
[[nodiscard]] inline float ripple_fade(const RippleRing& ring) {
    const bool on = ring.duration > 0 && ring.age > 0 && ring.age < ring.duration;
    return on ? 1.0f - ring.age / ring.duration : 0.0f;
}

template <typename Visitor>
void visit_fields(RippleRing& ring, Visitor&& visit) {
    visit("age", ring.age, {.doc = "since it began; negative: begins later", .unit = "s"});
    visit("duration", ring.duration, {.doc = "how long it lasts", .unit = "s", .min = 0.01});
    visit("period", ring.period, {.doc = "begins anew; 0 = once", .unit = "s", .min = 0});
    visit("speed", ring.speed, {.doc = "of the shell", .unit = "m/s", .min = 0});
    visit(
        "wavelength", ring.wavelength,
        {.doc = "half the thickness of the shell", .unit = "m", .min = 1e-3});
    visit(
        "amplitude", ring.amplitude,
        {.doc = "largest turn of a ray, at first", .unit = "rad", .min = -0.5, .max = 0.5});
    visit("start_radius", ring.start_radius, {.doc = "at age 0", .unit = "m", .min = 0});
}

template <typename Visitor>
void visit_fields(HeatHaze& haze, Visitor&& visit) {
    visit(
        "shape", haze.shape,
        {.doc = "of half-extent 1 in the entity's space", .values = "box ball"});
    visit(
        "strength", haze.strength,
        {.doc = "largest shift, as a share of the picture's height", .min = 0, .max = 0.2});
    visit("scale", haze.scale, {.doc = "size of an eddy", .unit = "m", .min = 1e-3});
    visit("rise", haze.rise, {.doc = "of the air", .unit = "m/s", .min = -100, .max = 100});
    visit("seed", haze.seed, {.doc = "of its eddies"});
}

template <typename Visitor>
void visit_fields(LensRain& rain, Visitor&& visit) {
    visit("amount", rain.amount, {.doc = "share of the places for drops", .min = 0, .max = 1});
    visit(
        "size", rain.size,
        {.doc = "of a large drop, as a share of the picture's height", .min = 0.005, .max = 0.5});
    visit(
        "speed", rain.speed,
        {.doc = "at which drops run down", .unit = "heights/s", .min = 0, .max = 10});
    visit("strength", rain.strength, {.doc = "of the refraction", .min = 0, .max = 4});
    visit("seed", rain.seed, {.doc = "of places and times"});
}

template <typename Visitor>
void visit_fields(ScreenRipple& ripple, Visitor&& visit) {
    visit("center", ripple.center, {.doc = "share of the picture from the left and from below"});
    visit("age", ripple.age, {.doc = "since it began; negative: begins later", .unit = "s"});
    visit("duration", ripple.duration, {.doc = "how long it lasts", .unit = "s", .min = 0.01});
    visit(
        "amplitude", ripple.amplitude,
        {.doc = "largest shift, as a share of the picture", .min = -1, .max = 1});
    visit("radius", ripple.radius, {.doc = "at age 0, as a share of the picture", .min = 0});
    visit("radius_speed", ripple.radius_speed, {.doc = "of the radius", .unit = "1/s"});
    visit("round", ripple.round, {.doc = "in pixels; otherwise an ellipse"});
    visit(
        "grid", ripple.grid,
        {.doc = "computed at a grid of so many points a side; 0 = every pixel",
         .min = 0,
         .max = 1024});
}

}  // namespace limn
