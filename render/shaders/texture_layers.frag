// One layer of a stack of images over those below it (texture_layers_pass.h); or the finished stack, encoded as its
// target.
// Techniques: tex.layer-stack
#version 450
#include "lib/tone.glsl"
#include "texture_layers_gpu.h"

layout(binding = kLayerUnit) uniform sampler2D layer;         // repeats
layout(binding = kLayerMapUnit) uniform sampler2D layer_map;  // repeats
layout(binding = kLayersBelowUnit) uniform sampler2D below;

uniform vec2 size;      // of the target [px]
uniform int blend;      // LayerBlend; -1: encodes what is below as sRGB, -2: copies it
uniform bool inverted;  // of alpha and map
uniform vec3 factor;
uniform vec2 scale;
uniform vec2 scroll;  // so far, 0 .. 1
uniform float angle;  // [rad]
uniform vec2 wave;    // amplitude, phase [rad]

layout(location = 0) out vec4 color;

const float kTurn = 6.28318531;

vec2 layer_uv(vec2 uv) {
    vec2 d = (uv - 0.5) * scale;
    vec2 turned = vec2(cos(angle) * d.x + sin(angle) * d.y, cos(angle) * d.y - sin(angle) * d.x) + 0.5 * scale;
    return turned + scroll + vec2(wave.x * sin(kTurn * uv.y + wave.y), 0.0);
}

void main() {
    vec2 uv = gl_FragCoord.xy / size;
    vec3 under = texelFetch(below, ivec2(gl_FragCoord.xy), 0).rgb;
    vec4 over = textureLod(layer, layer_uv(uv), 0.0) * vec4(factor, 1.0);
    float cover = blend == 3 ? over.a : textureLod(layer_map, uv, 0.0).r;
    cover = inverted ? 1.0 - cover : cover;
    vec3 mixed = mix(under, over.rgb, cover);
    mixed = blend == 0 ? over.rgb : blend == 1 ? under + over.rgb : blend == 2 ? under * over.rgb : mixed;
    mixed = blend == -1 ? srgb_encode(clamp(under, 0.0, 1.0)) : blend == -2 ? under : mixed;
    color = vec4(mixed, 1.0);
}
