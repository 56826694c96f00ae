// Block of layered materials (render/material/material_layers.h): the factors of their maps.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct LayersBlock {
    vec4 specular;  // rgb: reflectance of the dielectric at normal incidence, tinted, may exceed 1; w: its weight
    vec4 coat;      // clear coat, its roughness; z: anisotropy, w: iridescence
    vec4 sheen;     // w: roughness
    vec4 film;      // refractive index, thickness [nm] where its map is 0 and 1; w: rotation of the anisotropy [rad]
    vec4 coat_normal;  // x: strength of its map
};

// Bindings.
const uint kGbufferLayersUnit = 14u;
const uint kSheenAlbedoUnit = 33u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
