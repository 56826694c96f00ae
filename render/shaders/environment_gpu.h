// The surroundings: what the sky function needs, and the light it sends, projected. std140.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kStudioLamps = 6u;
const uint kMaxProbes = 8u;
const uint kReflectionLayers = 1u + kMaxProbes;  // what can be mirrored: the sky, then one a probe

// A soft box at infinity: the unit square of (dot(d, u), dot(d, v)) / dot(d, center).
struct StudioLamp {
    vec4 center;  // unit, toward it. w: width of its soft edge, share of the half side
    vec4 u;       // world direction across / tangent of the half width
    vec4 v;       // world direction up / tangent of the half height
    vec4 color;   // radiance
};

struct EnvironmentBlock {
    vec4 zenith;         // radiance, times the intensity. w: SkyKind
    vec4 horizon;        // w: intensity
    vec4 ground;
    vec4 sun_direction;  // unit, toward the first directional light
    vec4 sun_color;      // its irradiance [lx]; black: none
    vec4 reflection;     // x: levels of the reflection maps, y: their size [px]
    StudioLamp lamps[kStudioLamps];
};

// Irradiance / pi = sum coefficients[i] Y_i(normal), with the cosine lobe and the constants of Y folded in.
struct Irradiance {
    vec4 coefficients[9];
};

// A probe: where it counts, and what it saw.
struct ProbeRecord {
    vec4 place_from_world[3];  // rows; it counts fully within the unit ball or, of a room, the unit cube
    vec4 seen_from;            // world. w: layer of the reflection maps
    vec4 shape;                // x: 1 a room, 0 a ball with all it shows far away. y: 1 / width of the rim beyond
};

struct ProbeBlock {
    vec4 count;  // x
    ProbeRecord probes[kMaxProbes];
};

#ifdef __cplusplus
static_assert(sizeof(ProbeBlock) == 16 * (1 + 5 * kMaxProbes));
static_assert(sizeof(EnvironmentBlock) == 16 * (6 + 4 * kStudioLamps));
static_assert(sizeof(Irradiance) == 144);
}  // namespace limn::layout
#endif
