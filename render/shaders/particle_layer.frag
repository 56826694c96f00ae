// Upsamples a layer of half the resolution: bilinearly between the four nearest texels, without those on another
// surface than the pixel (render/particles/particle_layer.h).
// Techniques: particle.half-resolution
#version 450
#include "lib/view.glsl"
#include "particle_gpu.h"

layout(binding = kParticleLayerUnit) uniform sampler2D layer;
layout(binding = kParticleLayerDepthUnit) uniform sampler2D layer_depth;
layout(binding = kParticleDepthUnit) uniform sampler2D scene_depth;

layout(location = 0) out vec4 radiance;

const float kSameSurface = 0.1;  // difference of distances up to which texels are on one surface, as a fraction
const float kOnPlane = 0.02;     // distance from the plane of the four up to which a pixel is on it, as a fraction

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float here = texelFetch(scene_depth, at, 0).r;
    vec2 size = vec2(textureSize(layer, 0));
    vec2 texel = 0.5 * gl_FragCoord.xy;  // [texels]
    vec2 corner = clamp(floor(texel - 0.5), vec2(0.0), size - 2.0);
    vec4 four = textureGather(layer_depth, (corner + 1.0) / size);  // upper left, upper right, lower right, lower left

    // Depths are near / distance, so that their differences are fractions of distances, too.
    vec4 differences = abs(four - here);
    float least = min(min(differences.x, differences.y), min(differences.z, differences.w));
    float largest = max(max(differences.x, differences.y), max(differences.z, differences.w));
    vec2 right = clamp(texel - 0.5 - corner, 1e-3, 1.0 - 1e-3);  // no weight is 0, as a single texel may remain
    vec4 weights = vec4(1.0 - right.x, right.x, right.x, 1.0 - right.x) * vec4(right.yy, 1.0 - right.yy);
    float off_plane = abs(dot(weights, four) - here) + abs(four.x - four.y + four.z - four.w);
    bool is_one_surface = largest <= kSameSurface * here || off_plane <= kOnPlane * here;
    weights *= vec4(lessThanEqual(differences, vec4(is_one_surface ? largest : least + kSameSurface * here)));
    ivec2 first = ivec2(corner);
    radiance = (weights.x * texelFetchOffset(layer, first, 0, ivec2(0, 1))
                + weights.y * texelFetchOffset(layer, first, 0, ivec2(1, 1))
                + weights.z * texelFetchOffset(layer, first, 0, ivec2(1, 0)) + weights.w * texelFetch(layer, first, 0))
        / (weights.x + weights.y + weights.z + weights.w);
}
