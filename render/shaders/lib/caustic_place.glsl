// The maps of caustics_pass.h where they are read.

#include "caustics_gpu.h"

layout(binding = 20) uniform samplerBuffer water_lights;  // WaterLightHead, SunkenRecord, MirrorRecord, CausticPlace
layout(binding = 21) uniform sampler2D caustic_maps;      // light that arrives over the light that flat water sends

CausticPlace caustic_place(int index) {
    vec4 counts = texelFetch(water_lights, 0);
    int first = int(kHeadTexels) + int(counts.x) * int(kSunkenTexels) + int(counts.y) * int(kMirrorTexels)
                + index * int(kPlaceTexels);
    return CausticPlace(
        texelFetch(water_lights, first), texelFetch(water_lights, first + 1), texelFetch(water_lights, first + 2));
}

// At a place of the map, 0 .. 1.
float caustic_texel(CausticPlace place, vec2 uv) {
    vec2 texel = place.rect.xy + clamp(uv * place.rect.z, 0.5, place.rect.z - 0.5);
    return textureLod(caustic_maps, texel / vec2(textureSize(caustic_maps, 0)), 0.0).r;
}
