// One light of any type, read from a texture buffer as kLightTexels RGBA32F texels: on a software OpenGL a
// fetch of 16 bytes costs a fifth of four loads from a storage block. Directional lights come first, then
// point lights, then spots (light.interface: sorted by type, no type tag).

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct LightRecord {
    vec4 position;    // world [m]; of a directional light: unit, toward it. w: 1 / radius^2, 0 = endless
    vec4 color;       // [cd]; of a directional light [lx]. w: multiplier of Falloff::Smooth, 0 = Karis window
    vec4 polynomial;  // c, l, q of 1 / (c + l d + q d^2). w: SpotProfile
    vec4 axis;        // where a spot shines, times the scale of its profile. w: offset of its profile
};

const uint kLightTexels = 4u;

#ifdef __cplusplus
static_assert(sizeof(LightRecord) == 16 * kLightTexels);
}  // namespace limn::layout
#endif
