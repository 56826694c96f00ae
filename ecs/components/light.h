#pragma once

#include "ecs/base/math.h"
#include "ecs/components/periodic.h"
#include "ecs/reflect.h"

namespace limn {

// Lights are placed by the WorldTransform of their entity; spot and directional lights point along
// its local -z (as in KHR_lights_punctual). Color is linear Rec. 709; intensity multiplies it:
// candela [lm/sr] for point and spot lights, lux [lm/m^2] for directional ones.
// Techniques: engine.light-object, light.directional, light.point

/// Fall-off with the distance d from the light; every option reaches 0 at `radius`, unless that is
/// 0.
enum class Falloff : std::uint8_t {
    InverseSquare,  ///< 1/d^2, windowed by (1 - (d/r)^4)^2 clamped (Karis 2013): physical, the
                    ///< default
    Polynomial,     ///< 1/(c + l d + q d^2) (light.attenuation), with the same window
    Smooth,         ///< clamp(multiplier (1 - (d/r)^2), 0, 1) (engine.light-falloff)
    None,           ///< constant within the radius
};

/// Distance attenuation of a point or spot light.
struct Attenuation {
    Falloff falloff = Falloff::InverseSquare;
    float constant = 1.0f;
    float linear = 0.0f;
    float quadratic = 0.0f;
    float multiplier = 1.0f;
};

LIMN_FIELDS(Attenuation) {
    LIMN_FIELD(
        falloff, .doc = "fall-off with distance",
        .values = "inverse_square polynomial smooth none");
    LIMN_FIELD(constant, "c of polynomial", "", 0);
    LIMN_FIELD(linear, "l of polynomial", "1/m", 0);
    LIMN_FIELD(quadratic, "q of polynomial", "1/m^2", 0);
    LIMN_FIELD(multiplier, "m of smooth: widens the bright part", "", 1, 100);
}

struct PointLight {
    Vec3 color = {1, 1, 1};
    float intensity = 10.0f;
    float radius = 10.0f;
    Attenuation attenuation = {};
    bool enabled = true;
};

LIMN_FIELDS(PointLight) {
    LIMN_FIELD(color, .doc = "linear Rec. 709", .min = 0, .color = true);
    LIMN_FIELD(intensity, "luminous intensity", "cd", 0, 1e6);
    LIMN_FIELD(radius, "distance at which it has faded to 0; 0 = unbounded", "m", 0, 1e5);
    LIMN_FIELD(attenuation, "distance attenuation");
    LIMN_FIELD(enabled, "whether the light is on");
}

/// The profile of a spot light between its two cones (light.spot-falloff).
enum class SpotProfile : std::uint8_t { LinearCosine, Smoothstep, LinearAngle };

struct SpotLight {
    Vec3 color = {1, 1, 1};
    float intensity = 20.0f;
    float radius = 15.0f;
    Attenuation attenuation = {};
    float inner_angle = radians(20.0f);
    float outer_angle = radians(30.0f);
    SpotProfile profile = SpotProfile::Smoothstep;
    bool enabled = true;
};

LIMN_FIELDS(SpotLight) {
    LIMN_FIELD(color, .doc = "linear Rec. 709", .min = 0, .color = true);
    LIMN_FIELD(intensity, "luminous intensity", "cd", 0, 1e6);
    LIMN_FIELD(radius, "distance at which it has faded to 0; 0 = unbounded", "m", 0, 1e5);
    LIMN_FIELD(attenuation, "distance attenuation");
    LIMN_FIELD(inner_angle, "half angle of full intensity", "rad", 0, 1.5708);
    LIMN_FIELD(outer_angle, "half angle at which it reaches 0", "rad", 0, 1.5708);
    LIMN_FIELD(
        profile, .doc = "fall-off between the inner and outer cone",
        .values = "linear_cosine smoothstep linear_angle");
    LIMN_FIELD(enabled, "whether the light is on");
}

struct DirectionalLight {
    Vec3 color = {1, 1, 1};
    float illuminance = 3.0f;
    bool enabled = true;
};

LIMN_FIELDS(DirectionalLight) {
    LIMN_FIELD(color, .doc = "linear Rec. 709", .min = 0, .color = true);
    LIMN_FIELD(illuminance, "illuminance on a surface perpendicular to the light", "lx", 0, 1e6);
    LIMN_FIELD(enabled, "whether the light is on");
}

/// On a directional light: the sun, or the moon, above the air. The color and the illuminance of
/// the light are what the air of the sky `atmosphere` lets through from its direction
/// (update_sunlight), and that sky scatters the rest.
struct Sunlight {
    Vec3 color = {1, 1, 1};
    float illuminance = 6.67f;
};

LIMN_FIELDS(Sunlight) {
    LIMN_FIELD(color, .doc = "above the air, linear Rec. 709", .min = 0, .color = true);
    LIMN_FIELD(
        illuminance,
        "above the air, perpendicular to the light; the default is the sun's in units of 20 klx",
        "lx", 0, 1e6);
}

/// Modulates the light on the same entity (the `function` of engine.light-object): its intensity is
/// multiplied by a periodic function, never below 0, its color led to another one and back.
struct LightPulse {
    PeriodicFunction function = {.base = 1, .amplitude = 0.5f, .frequency = 0.64f};
    Vec3 color = {1, 1, 1};
    PeriodicFunction color_function = constant_function(0);
};

LIMN_FIELDS(LightPulse) {
    visit_fields(self.function, visit);
    LIMN_FIELD(color, .doc = "other color, which color_function leads to", .min = 0, .color = true);
    LIMN_FIELD(color_function, "weight of the other color, clamped to 0 .. 1");
}

}  // namespace limn
