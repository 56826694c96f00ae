// A normal map of skin with the wrinkles of its face: see lib/wrinkle_maps.glsl.
// Techniques: skin.pipeline
#version 450
#include "lib/wrinkle_maps.glsl"
#include "wrinkle_maps_gpu.h"

layout(binding = kWrinkleBaseUnit) uniform sampler2D base;
layout(binding = kWrinkleStretchedUnit) uniform sampler2D stretched;
layout(binding = kWrinkleCompressedUnit) uniform sampler2D compressed;
layout(binding = kWrinkleFirstMasksUnit) uniform sampler2D first_masks;
layout(binding = kWrinkleSecondMasksUnit) uniform sampler2D second_masks;
layout(binding = kWrinkleThirdMasksUnit) uniform sampler2D third_masks;

uniform vec2 size;            // of the target [px]
uniform vec4 first_weights;   // -1 .. 1
uniform vec4 second_weights;
uniform float third_weight;   // of the chin
uniform vec4 decoding;        // scale and offset of texels of the stretched map (xy) and the compressed one (zw)
uniform float strength;       // factor of the influence of both maps, 0 .. 1
uniform bool by_slopes;

layout(location = 0) out vec4 normal;

void main() {
    vec2 uv = gl_FragCoord.xy / size;
    vec4 skin = textureLod(base, uv, 0.0);
    vec2 influence = strength * wrinkle_influence(
        textureLod(first_masks, uv, 0.0), textureLod(second_masks, uv, 0.0), textureLod(third_masks, uv, 0.0).r,
        first_weights, second_weights, third_weight);
    if (influence == vec2(0.0)) {
        normal = skin;  // unchanged, to the bit
        return;
    }
    vec3 n = 2.0 * skin.xyz - 1.0;
    vec3 w1 = textureLod(stretched, uv, 0.0).xyz * decoding.x + decoding.y;
    vec3 w2 = textureLod(compressed, uv, 0.0).xyz * decoding.z + decoding.w;
    vec3 composed = by_slopes ? compose_by_slopes(n, w1, w2, influence) : compose_by_lerp(n, w1, w2, influence);
    normal = vec4(0.5 + 0.5 * composed, skin.w);
}
