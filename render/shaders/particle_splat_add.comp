// Adds the sums of particle_splat.comp to the image and sets them to 0. Definition: that of
// lib/radiance_image.glsl.
#version 450
#include "lib/radiance_image.glsl"
#include "particle_gpu.h"

layout(local_size_x = 64) in;
layout(std430, binding = kSplatSumsBinding) buffer Sums {
    uint sums[];  // of red, green and blue of each pixel
};

uniform float unit;  // of radiance, in the sums

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(radiance);
    if (pixel.x >= size.x) {
        return;
    }
    int first = 3 * (pixel.y * size.x + pixel.x);
    uvec3 sum = uvec3(sums[first], sums[first + 1], sums[first + 2]);
    if (sum == uvec3(0)) {
        return;
    }
    for (int i = 0; i < 3; ++i) {
        sums[first + i] = 0u;
    }
    add_radiance(pixel, vec3(sum) / unit);
}
