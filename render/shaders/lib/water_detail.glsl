// Water detail too fine for displacement, which only tilts normals: scrolling layers of a normal map, and waves in a
// texture. Include after lib/water_surface.glsl. Definitions DETAIL and, with a normal map, DETAIL_MAP.
// Techniques: water.geometric-texture-split, water.scrolling-normal-map

#ifdef DETAIL
#include "water_detail_gpu.h"

layout(binding = kDetailWavesUnit) uniform sampler2DArray detail_waves;  // texture_waves.frag
layout(binding = kWaterDetailsUnit) uniform samplerBuffer water_details;  // WaterDetailRecord

#ifdef DETAIL_MAP
layout(binding = kDetailMapUnit) uniform sampler2D detail_map;         // tangent space, green toward -z; repeats

// Slope variance within a texel of a filtered normal map: the more its unit vectors differ, the shorter their mean
// (Toksvig 2005).
float slope_variance(vec3 mean) {
    float mean_length = clamp(length(mean), 0.1, 1.0);
    return 2.0 * (1.0 - mean_length) / mean_length;
}

// Adds the mean of the layers, sum (n.xy strength, n.z).
void add_layers(inout WaterBend bend, int first, int count, vec2 q, float footprint) {
    vec3 sum = vec3(0.0);
    float variance = 0.0;
    float size = float(textureSize(detail_map, 0).x);
    for (int i = 0; i < count; ++i) {
        vec4 layer = texelFetch(water_details, first + 1 + i);
        float level = max(log2(footprint * layer.x * size), 0.0);
        vec3 n = 2.0 * textureLod(detail_map, q * layer.x - layer.yz, level).xyz - 1.0;
        sum += vec3(n.xy * layer.w, n.z);
        variance += layer.w * layer.w * min(level, 1.0) * slope_variance(n);  // level 0 has only rounding errors
    }
    if (count > 0) {
        vec2 tilt = sum.xy / max(sum.z, 0.1);
        bend.by_x.y -= tilt.x;
        bend.by_z.y += tilt.y;
        bend.variance += variance / float(count * count);
    }
}

#endif

void add_detail(inout WaterBend bend, int body, vec2 q, float footprint) {
    int first = body * int(kWaterDetailTexels);
    vec4 waves = texelFetch(water_details, first);
    if (waves.x >= 0.0) {
        float level = max(log2(footprint * waves.y * float(textureSize(detail_waves, 0).x)), 0.0);
        vec4 slopes = textureLod(detail_waves, vec3(q * waves.y, waves.x), level);
        bend.by_x.y += slopes.x;
        bend.by_z.y += slopes.y;
        bend.variance += waves.z + max(slopes.z - dot(slopes.xy, slopes.xy), 0.0);
    }
#ifdef DETAIL_MAP
    add_layers(bend, first, int(waves.w), q, footprint);
#endif
}
#else
void add_detail(inout WaterBend bend, int body, vec2 q, float footprint) {}
#endif
