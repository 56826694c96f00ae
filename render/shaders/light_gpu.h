// One light of any type, read from a texture buffer as kLightTexels RGBA32F texels: on a software OpenGL a
// fetch of 16 bytes costs a fifth of four loads from a storage block. Directional lights come first, then
// point lights, then spots (light.interface: sorted by type, no type tag), then point and spot lights with shadows
// or cookies.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct LightRecord {
    vec4 position;    // world [m]; of a directional light: unit, toward it. w: 1 / radius^2, 0 = unbounded
    vec4 color;       // [cd]; of a directional light [lx]. w: multiplier of Falloff::Smooth, 0 = Karis window
    vec4 polynomial;  // c, l, q of 1 / (c + l d + q d^2). w: SpotProfile
    vec4 axis;        // direction of a spot, times the scale of its profile. w: offset of its profile
    vec4 shadow;      // first shadow view (or mask layer), kShadow*, number of views, index of its cookie + 1 or 0
};

const uint kLightTexels = 5u;

// LightRecord::shadow.y: what light_visibility() reads.
const float kShadowNone = 0.0;      // unshadowed
const float kShadowView = 1.0;      // one view: a spot, or a perspective map
const float kShadowCube = 2.0;      // six faces: a point light
const float kShadowCascades = 3.0;  // a sun's, near to far
const float kShadowMask = 4.0;      // a layer of the screen-space shadow mask: shadow volumes

// Bindings.
const uint kLightsUnit = 9u;
const uint kLightIndicesUnit = 10u;
const uint kLightCellsUnit = 11u;

#ifdef __cplusplus
static_assert(sizeof(LightRecord) == 16 * kLightTexels);
}  // namespace limn::layout
#endif
