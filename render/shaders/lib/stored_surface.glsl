// Surfaces of the G-buffer as the lighting passes read them. Definition MATERIAL_RECORDS: some shading model reads the
// record of its material when lit; SHADE_LAYERED: some material has layers; KEY_SHADOWS: lib/key_lights.glsl.

#include "lib/gbuffer.glsl"
#include "gbuffer_gpu.h"
#include "material_layers_gpu.h"

layout(binding = kGbufferUnit) uniform usampler2D gbuffer;
layout(binding = kDepthUnit) uniform sampler2D scene_depth;
#ifdef MATERIAL_RECORDS
layout(binding = kGbufferMaterialUnit) uniform usampler2D gbuffer_material;
#endif
#ifdef KEY_SHADOWS
layout(binding = kGbufferKeyLightUnit) uniform sampler2D gbuffer_key_light;
#endif
#ifdef LAYERED
layout(binding = kGbufferLayersUnit) uniform usampler2D gbuffer_layers;
#endif

SurfaceSample stored_surface(ivec2 pixel) {
    SurfaceSample s = unpack_surface(texelFetch(gbuffer, pixel, 0));
#ifdef MATERIAL_RECORDS
    uvec2 material = texelFetch(gbuffer_material, pixel, 0).rg;
    s.material = material.x;
#ifdef LAYERED
    s.layers = unpack_layers(PackedLayers(texelFetch(gbuffer_layers, pixel, 0), material.y), s.normal_ws);
#endif
#endif
#ifdef KEY_SHADOWS
    s.key_visibility = texelFetch(gbuffer_key_light, pixel, 0).rg;
#endif
    return s;
}
