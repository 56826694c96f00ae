// The environment: parameters of the sky, its irradiance in spherical harmonics, and light probes. std140.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kStudioLamps = 6u;
const uint kMaxProbes = 8u;
const uint kReflectionLayers = 1u + kMaxProbes;  // of reflection maps: the sky, then one per probe

// A soft box at infinity: the unit square of (dot(d, u), dot(d, v)) / dot(d, center).
struct StudioLamp {
    vec4 center;  // unit, toward it. w: width of its soft edge, as a fraction of the half side
    vec4 u;       // world direction across / tangent of the half width
    vec4 v;       // world direction up / tangent of the half height
    vec4 color;   // radiance
};

struct EnvironmentBlock {
    vec4 zenith;         // radiance, times the intensity; atmosphere: the sun's irradiance above the air. w: SkyKind
    vec4 horizon;        // w: intensity
    vec4 ground;
    vec4 sun_direction;  // unit, toward the first directional light; atmosphere: the first sunlight
    vec4 sun_color;      // its irradiance [lx]; black: no sun
    vec4 reflection;     // x: mip levels of the reflection maps, y: their size [px]
    StudioLamp lamps[kStudioLamps];
};

// Irradiance / pi = sum coefficients[i] Y_i(normal), with the cosine lobe and the constants of Y folded in.
struct Irradiance {
    vec4 coefficients[9];
};

// A light probe: its region of influence and its captured environment.
struct ProbeRecord {
    vec4 probe_from_world[3];  // rows; full weight inside the unit ball or, for a room, the unit cube
    vec4 capture_position;     // world. w: layer of the reflection maps
    vec4 shape;                // x: 1 = a room with parallax, 0 = a ball without. y: 1 / width of the fade beyond
};

struct ProbeBlock {
    vec4 count;  // x
    ProbeRecord probes[kMaxProbes];
};

// Bindings.
const uint kEnvironmentBinding = 1u;
const uint kSkyCubeUnit = 5u;
const uint kPanoramaUnit = 5u;
const uint kProbeFaceUnit = 5u;
const uint kIrradianceSumsBinding = 0u;
const uint kReflectionMapsUnit = 7u;
const uint kSpecularAlbedoUnit = 8u;
const uint kSurroundingsBinding = 5u;
const uint kProbesBinding = 6u;

#ifdef __cplusplus
static_assert(sizeof(ProbeBlock) == 16 * (1 + 5 * kMaxProbes));
static_assert(sizeof(EnvironmentBlock) == 16 * (6 + 4 * kStudioLamps));
static_assert(sizeof(Irradiance) == 144);
}  // namespace limn::layout
#endif
