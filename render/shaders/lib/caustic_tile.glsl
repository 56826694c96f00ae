// Sampling of the caustic maps of caustics_pass.h.

#include "caustics_gpu.h"

layout(binding = kWaterLightsUnit) uniform samplerBuffer water_lights;  // WaterLightHeader, UnderwaterRecord, MirrorRecord, CausticTile
layout(binding = kCausticMapsUnit) uniform sampler2D caustic_maps;      // light relative to that under flat water

CausticTile caustic_tile(int index) {
    vec4 counts = texelFetch(water_lights, 0);
    int first = int(kHeaderTexels) + int(counts.x) * int(kUnderwaterTexels) + int(counts.y) * int(kMirrorTexels)
                + index * int(kCausticTileTexels);
    return CausticTile(
        texelFetch(water_lights, first), texelFetch(water_lights, first + 1), texelFetch(water_lights, first + 2));
}

// Samples the map at uv in 0 .. 1.
float caustic_texel(CausticTile tile, vec2 uv) {
    vec2 texel = tile.rect.xy + clamp(uv * tile.rect.z, 0.5, tile.rect.z - 0.5);
    return textureLod(caustic_maps, texel / vec2(textureSize(caustic_maps, 0)), 0.0).r;
}

const float kPathBias = 2e-3;

// Fraction of a map's light that is unoccluded up to `length` [m] below or above the water. Include after
// lib/shadow.glsl.
float path_visibility(CausticTile tile, vec2 uv, float length) {
    float path = length / tile.view.z;
#if defined(SHADOWS) && defined(SHADOW_MAPS)
    vec4 rect = texelFetch(shadow_views, max(int(tile.view.x), 0) * int(kShadowViewTexels) + 7);
    vec2 texel = clamp(mix(rect.xy, rect.zw, uv), rect.xy + 1.0, rect.zw - 1.0);
    vec2 corner = floor(texel - 0.5);
    vec2 fraction = texel - 0.5 - corner;
    vec4 depths = textureGather(shadow_atlas, (corner + 1.0) / vec2(textureSize(shadow_atlas, 0)));
    vec4 open = vec4(lessThanEqual(depths, vec4(1.0 + kPathBias - path)));
    float visible = mix(mix(open.w, open.z, fraction.x), mix(open.x, open.y, fraction.x), fraction.y);
    return tile.view.x >= 0.0 ? visible : 1.0;
#else
    return 1.0;
#endif
}
