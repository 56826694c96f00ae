// Irradiance of a cube map: projects it on nine spherical harmonics, by one work group that sums the texels of a small
// mip level in a fixed order (Ramamoorthi and Hanrahan 2001).
// Techniques: env.image-based-light
#version 450
#include "lib/cube_map.glsl"
#include "lib/irradiance.glsl"
#include "environment_gpu.h"

const uint kThreads = 128u;
layout(local_size_x = 128) in;

layout(binding = kSkyCubeUnit) uniform samplerCube cube;
layout(std430, binding = kIrradianceSumsBinding) writeonly buffer Sums {
    Irradiance sums[];
};

uniform int level;
uniform int layer;  // of `sums`

shared vec4 parts[kThreads][9];  // w of the first: solid angle

void main() {
    uint thread = gl_LocalInvocationIndex;
    uint side = uint(textureSize(cube, level).x);
    vec4 sum[9];
    for (int k = 0; k < 9; ++k) {
        sum[k] = vec4(0.0);
    }
    for (uint i = thread; i < 6u * side * side; i += kThreads) {
        uvec2 texel = uvec2(i % side, i / side % side);
        vec3 d = cube_direction(int(i / (side * side)), (vec2(texel) + 0.5) / float(side));
        float inverse_length = inversesqrt(dot(d, d));
        float solid_angle = inverse_length * inverse_length * inverse_length;  // up to a factor, normalized below
        float h[9] = harmonics(d * inverse_length);
        vec3 radiance = textureLod(cube, d, float(level)).rgb;
        for (int k = 0; k < 9; ++k) {
            sum[k] += solid_angle * vec4(radiance * h[k], 1.0);
        }
    }
    for (int k = 0; k < 9; ++k) {
        parts[thread][k] = sum[k];
    }
    for (uint step = kThreads / 2u; step > 0u; step /= 2u) {
        barrier();
        if (thread < step) {
            for (int k = 0; k < 9; ++k) {
                parts[thread][k] += parts[thread + step][k];
            }
        }
    }
    barrier();
    if (thread < 9u) {
        float scale = 4.0 * 3.14159265358979 / parts[0][0].w;
        sums[layer].coefficients[thread] = vec4(parts[0][thread].rgb * (scale * kHarmonicFactors[thread]), 0.0);
    }
}
