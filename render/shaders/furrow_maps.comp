// Height with noise and perturbed normals of grown furrows, one invocation per pixel, as in
// content/bake/furrow_height.cpp.
// Techniques: wrinkle.furrow.normal-perturb
#version 450
#include "lib/furrow.glsl"
#include "lib/philox.glsl"
#include "furrow_gpu.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = kFurrowTrianglesBinding) readonly buffer Triangles {
    float triangles[];  // FurrowTriangle, tightly packed
};
layout(std430, binding = kFurrowCoverBinding) readonly buffer Cover {
    int cover[];
};
layout(std430, binding = kFurrowHeightsBinding) readonly buffer Heights {
    uint heights[];  // of field 0, then of field 1
};
layout(rgba32f, binding = kFurrowHeightImage) writeonly uniform image2D height_map;  // first, second, with noise, 1
layout(rgba16f, binding = kFurrowNormalImage) writeonly uniform image2D normal_map;

uniform float noise;
uniform float bump;
uniform uint key_x, key_y;  // of the random numbers

vec2 both_heights(int pixel) {
    return uintBitsToFloat(uvec2(heights[pixel], heights[size.x * size.y + pixel]));
}

float height_at(int pixel) {
    vec2 both = both_heights(pixel);
    uvec4 words = philox(uvec4(0u, 0u, uint(pixel) / 4u, 0u), uvec2(key_x, key_y));
    return min(both.x, both.y) - unit_float(words[pixel % 4]) * noise;
}

vec3 triangle_vec3(int triangle, int at) {
    int i = 27 * triangle + at;
    return vec3(triangles[i], triangles[i + 1], triangles[i + 2]);
}

vec3 base_normal(int triangle, ivec2 at) {
    vec2 offset = vec2(at) + 0.5 - triangle_vec3(triangle, 0).xy;
    vec3 n = triangle_vec3(triangle, 18) + triangle_vec3(triangle, 21) * offset.x + triangle_vec3(triangle, 24) * offset.y;
    float length2 = dot(n, n);
    return length2 > 1e-30 ? n * inversesqrt(length2) : vec3(0.0, 0.0, 1.0);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, size))) {
        return;
    }
    int pixel = at.y * size.x + at.x;
    float height = height_at(pixel);
    vec3 normal = vec3(0.0, 0.0, 1.0);
    if (cover[pixel] >= 0) {
        int right = pixel_index(at + ivec2(1, 0));
        int up = pixel_index(at - ivec2(0, 1));
        vec2 slope = vec2(
            right >= 0 && cover[right] >= 0 ? height_at(right) - height : 0.0,
            up >= 0 && cover[up] >= 0 ? height_at(up) - height : 0.0);
        vec3 n = base_normal(cover[pixel], at);
        vec3 gradient = vec3(bump * slope, 0.0);
        normal = normalize(n - (gradient - dot(gradient, n) * n));
    }
    imageStore(height_map, at, vec4(both_heights(pixel), height, 1.0));
    imageStore(normal_map, at, vec4(normal, 1.0));
}
