#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

// Techniques: light.height-fog, light.airlight
// Source of light.height-fog: Quílez, "Better fog", 2010; Henyey and Greenstein 1941
// Source of light.airlight: Kulla and Fajardo 2012

/// Resource: fog that thins with height, extinction = density exp(-(y - base) / scale_height), and
/// scatters what it takes. It lies in front of surfaces, water, glass, particles and the sky.
struct HeightFog {
    float density = 0.01f;
    float base = 0.0f;
    float scale_height = 20.0f;
    Vec3 ambient = {0.5f, 0.55f, 0.6f};
    float sun = 1.0f;
    float forward = 0.6f;
    float lamps = 0.0f;
};

LIMN_FIELDS(HeightFog) {
    LIMN_FIELD(
        density, "extinction at the base; 3 / density is about as far as one can see", "1/m", 0,
        10);
    LIMN_FIELD(base, "height at which the density is that", "m");
    LIMN_FIELD(scale_height, "over which the density falls to 37 %", "m", 0.1, 1e5);
    LIMN_FIELD(
        ambient, .doc = "mean radiance from all around, which thick fog takes on", .min = 0,
        .max = 1e5, .color = true);
    LIMN_FIELD(
        sun, "factor on the light that it scatters from the first directional light", "", 0, 10);
    LIMN_FIELD(
        forward, "how much light is scattered on: 0 to all sides, 0.6 haze, 0.85 dense fog", "", 0,
        0.95);
    LIMN_FIELD(
        lamps,
        "factor on the light that it scatters from the 16 strongest point lights and spots: halos "
        "and beams; their shadows are left out",
        "", 0, 10);
}

}  // namespace limn
