#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

// Lights shine from where their entity's WorldTransform is; spot and directional lights shine along
// its local -z (as KHR_lights_punctual). Color is linear Rec. 709; intensity multiplies it: candela
// [lm/sr] for point and spot lights, lux [lm/m^2] for directional ones.

/// How a light fades with the distance d from it; every option reaches 0 at `radius` unless it is
/// 0.
enum class Falloff : std::uint8_t {
    InverseSquare,  ///< 1/d^2, windowed by (1 - (d/r)^4)^2 clamped (Karis 2013): physical, the
                    ///< default
    Polynomial,     ///< 1/(c + l d + q d^2) (light.attenuation), with the same window
    Smooth,         ///< clamp(multiplier (1 - (d/r)^2), 0, 1) (engine.light-falloff)
    None,           ///< constant within the radius
};

/// What fades a point or spot light.
struct Attenuation {
    Falloff falloff = Falloff::InverseSquare;
    float constant = 1.0f;    ///< c of Polynomial, >= 0
    float linear = 0.0f;      ///< l of Polynomial [1/m], >= 0
    float quadratic = 0.0f;   ///< q of Polynomial [1/m^2], >= 0
    float multiplier = 1.0f;  ///< m of Smooth, >= 1: widens the bright part
};

struct PointLight {
    Vec3 color = {1, 1, 1};   ///< linear, >= 0
    float intensity = 10.0f;  ///< [cd], >= 0
    float radius = 10.0f;     ///< where it has faded to nothing [m]; 0: never fades to nothing
    Attenuation attenuation = {};
    bool enabled = true;
};

/// The profile of a spot light between its two cones (light.spot-falloff).
enum class SpotProfile : std::uint8_t { LinearCosine, Smoothstep, LinearAngle };

struct SpotLight {
    Vec3 color = {1, 1, 1};
    float intensity = 20.0f;  ///< [cd]
    float radius = 15.0f;     ///< [m]
    Attenuation attenuation = {};
    float inner_angle = radians(20.0f);  ///< half angle of full light [rad], 0 .. outer_angle
    float outer_angle = radians(30.0f);  ///< half angle where it ends [rad], inner_angle .. pi/2
    SpotProfile profile = SpotProfile::Smoothstep;
    bool enabled = true;
};

struct DirectionalLight {
    Vec3 color = {1, 1, 1};
    float illuminance = 3.0f;  ///< on a surface that faces it [lx]
    bool enabled = true;
};

/// What a pulse follows.
enum class PulseShape : std::uint8_t {
    Sine,   ///< sin(frequency t + phase)
    Noise,  ///< flickers like a flame, about as fast; other phases flicker otherwise
};

/// Modulates the intensity of the light beside it (the `function` of engine.light-object):
/// intensity x (1 + amplitude shape(t)), never below 0.
struct LightPulse {
    PulseShape shape = PulseShape::Sine;
    float amplitude = 0.5f;  ///< 0 .. 1
    float frequency = 4.0f;  ///< [rad/s]
    float phase = 0.0f;      ///< [rad]
};

template <typename Visitor>
void visit_fields(Attenuation& attenuation, Visitor&& visit) {
    visit(
        "falloff", attenuation.falloff,
        {.doc = "how the light fades with distance",
         .values = "inverse_square polynomial smooth none"});
    visit("constant", attenuation.constant, {.doc = "c of polynomial", .min = 0});
    visit("linear", attenuation.linear, {.doc = "l of polynomial", .unit = "1/m", .min = 0});
    visit(
        "quadratic", attenuation.quadratic, {.doc = "q of polynomial", .unit = "1/m^2", .min = 0});
    visit(
        "multiplier", attenuation.multiplier,
        {.doc = "m of smooth: widens the bright part", .min = 1, .max = 100});
}

template <typename Visitor>
void visit_fields(PointLight& light, Visitor&& visit) {
    visit("color", light.color, {.doc = "linear Rec. 709", .min = 0, .color = true});
    visit(
        "intensity", light.intensity,
        {.doc = "luminous intensity", .unit = "cd", .min = 0, .max = 1e6});
    visit(
        "radius", light.radius,
        {.doc = "where it has faded to nothing; 0 = never", .unit = "m", .min = 0, .max = 1e5});
    visit("attenuation", light.attenuation, {.doc = "how it fades with distance"});
    visit("enabled", light.enabled, {.doc = "shines at all"});
}

template <typename Visitor>
void visit_fields(SpotLight& light, Visitor&& visit) {
    visit("color", light.color, {.doc = "linear Rec. 709", .min = 0, .color = true});
    visit(
        "intensity", light.intensity,
        {.doc = "luminous intensity", .unit = "cd", .min = 0, .max = 1e6});
    visit(
        "radius", light.radius,
        {.doc = "where it has faded to nothing; 0 = never", .unit = "m", .min = 0, .max = 1e5});
    visit("attenuation", light.attenuation, {.doc = "how it fades with distance"});
    visit(
        "inner_angle", light.inner_angle,
        {.doc = "half angle of full light", .unit = "rad", .min = 0, .max = 1.5708});
    visit(
        "outer_angle", light.outer_angle,
        {.doc = "half angle where it ends", .unit = "rad", .min = 0, .max = 1.5708});
    visit(
        "profile", light.profile,
        {.doc = "between the two cones", .values = "linear_cosine smoothstep linear_angle"});
    visit("enabled", light.enabled, {.doc = "shines at all"});
}

template <typename Visitor>
void visit_fields(DirectionalLight& light, Visitor&& visit) {
    visit("color", light.color, {.doc = "linear Rec. 709", .min = 0, .color = true});
    visit(
        "illuminance", light.illuminance,
        {.doc = "on a surface that faces it", .unit = "lx", .min = 0, .max = 1e6});
    visit("enabled", light.enabled, {.doc = "shines at all"});
}

template <typename Visitor>
void visit_fields(LightPulse& pulse, Visitor&& visit) {
    visit("shape", pulse.shape, {.doc = "what it follows", .values = "sine noise"});
    visit(
        "amplitude", pulse.amplitude,
        {.doc = "share of the intensity that comes and goes", .min = 0, .max = 1});
    visit(
        "frequency", pulse.frequency,
        {.doc = "angular frequency", .unit = "rad/s", .min = 0, .max = 1000});
    visit("phase", pulse.phase, {.doc = "phase at time 0", .unit = "rad"});
}

}  // namespace limn
