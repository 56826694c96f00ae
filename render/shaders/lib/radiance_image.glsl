// The radiance of a view as an image that a compute shader reads and writes. Definition:
//   FULL_FLOATS  it has 32-bit floats, not 16-bit ones

#include "lib/radiance.glsl"
#include "fullscreen_gpu.h"

#ifdef FULL_FLOATS
layout(binding = kTargetImage, rgba32f) uniform image2D radiance;
#else
layout(binding = kTargetImage, rgba16f) uniform image2D radiance;
#endif

void add_radiance(ivec2 pixel, vec3 light) {
    vec4 before = imageLoad(radiance, pixel);
    imageStore(radiance, pixel, vec4(storable(before.rgb + storable(light)), before.a));
}
