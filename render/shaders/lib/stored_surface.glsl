// Surfaces of the G-buffer as the lighting passes read them. Definition MATERIAL_RECORDS: some shading model reads the
// record of its material when lit.

#include "lib/gbuffer.glsl"
#include "gbuffer_gpu.h"

layout(binding = kGbufferUnit) uniform usampler2D gbuffer;
layout(binding = kDepthUnit) uniform sampler2D scene_depth;
#ifdef MATERIAL_RECORDS
layout(binding = kGbufferMaterialUnit) uniform usampler2D gbuffer_material;
#endif

SurfaceSample stored_surface(ivec2 pixel) {
    SurfaceSample s = unpack_surface(texelFetch(gbuffer, pixel, 0));
#ifdef MATERIAL_RECORDS
    s.material = texelFetch(gbuffer_material, pixel, 0).r;
#endif
    return s;
}
