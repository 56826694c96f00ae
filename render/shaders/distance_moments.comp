// The moments of the distance at each pixel, as distance_moments.frag writes them.
#version 450
#include "lib/distance_moments.glsl"
#include "material_subsurface_gpu.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kDistanceMomentsImage, rg32f) writeonly uniform image2D moments;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(pixel, imageSize(moments)))) {
        imageStore(moments, pixel, vec4(distance_moments(pixel), 0.0, 0.0));
    }
}
