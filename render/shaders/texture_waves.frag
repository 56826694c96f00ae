// Slopes of the waves that fit into a tile: by x, by z, and the sum of their squares, whose mean gives the variance
// that mip levels lose.
// Techniques: water.geometric-texture-split
#version 450
#include "water_detail_gpu.h"

layout(binding = kTextureWavesUnit) uniform samplerBuffer waves;  // TextureWaveRecord

uniform int first;
uniform int count;
uniform float texels;  // per side

layout(location = 0) out vec4 slopes;

const float kTurn = 6.28318530718;

void main() {
    vec2 tile_uv = gl_FragCoord.xy / texels;
    vec2 slope = vec2(0.0);
    for (int i = first; i < first + count; ++i) {
        vec4 wave = texelFetch(waves, i);
        // Reduced to one period, for the precision of the cosine.
        slope += wave.w * wave.xy * cos(kTurn * fract(dot(wave.xy, tile_uv)) + wave.z);
    }
    slopes = vec4(slope, dot(slope, slope), 0.0);
}
