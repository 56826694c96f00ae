// The ramp of the shading model Toon, as a one-dimensional map whose colors blend over a few of 256 texels.
// Techniques: tex.toon-ramp

#include "lib/material_record.glsl"
#include "material_toon_gpu.h"

// Rises from 0 to 1 about `edge`, over the width of a blend.
float toon_step(float edge, float x) {
    return clamp((x - edge) / kToonBlend + 0.5, 0.0, 1.0);
}

// Color of the light `u` on a ramp with `count` bands.
vec3 toon_ramp(uint material, int count, float u) {
    int next = clamp(int(u * float(count) + 0.5), 1, max(count - 1, 1));  // the band after the nearest edge
    vec3 below = block_texel(material, kToonBlock, next - 1).rgb;
    vec3 above = block_texel(material, kToonBlock, min(next, count - 1)).rgb;
    return mix(below, above, toon_step(float(next) / float(count), u));
}
