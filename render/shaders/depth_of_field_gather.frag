// Gathers the far and near layers at half resolution. For fine circles, tests for every neighboring texel whether its
// circle covers this one; its light is weighted by 1 / the area of the circle.
#version 450
#include "lib/depth_of_field.glsl"
#include "depth_of_field_gpu.h"

layout(binding = kFocusFarLightUnit) uniform sampler2D far_light;
layout(binding = kFocusNearLightUnit) uniform sampler2D near_light;
layout(binding = kFocusFarKernelsUnit) uniform sampler2D far_kernels;
layout(binding = kFocusNearKernelsUnit) uniform sampler2D near_kernels;
layout(binding = kFocusFarWideUnit) uniform sampler2D far_wide;
layout(binding = kFocusFarCoarseUnit) uniform sampler2D far_coarse;  // quarter resolution
layout(binding = kFocusNearCoarseUnit) uniform sampler2D near_coarse;
layout(binding = kFocusNearRadiusUnit) uniform sampler2D near_radius;

flat in vec4 tile;

layout(location = 0) out vec4 far_blurred;   // alpha: confidence
layout(location = 1) out vec4 near_blurred;  // alpha: coverage

// Coverage by a kernel of `radius` of a texel on the rim of the aperture of radius `aperture`.
float kernel_coverage(float radius, float aperture) {
    return clamp(radius + 0.5 - aperture, 0.0, 1.0);
}

// Fine far circles over wide ones, for a texel with kernel `own`. That bounds the circles of farther texels, which
// would otherwise bleed over it. Fine circles are always in front of wide ones.
vec4 gather_far(ivec2 here, vec2 own, bool is_fine, float range, vec4 behind) {
    ivec2 last = ivec2(focus.size.zw) - 1;
    vec4 front = vec4(0.0);
    for (int i = 0; i < kFineTaps && focus.texel[i].z < range + 0.5; ++i) {
        ivec2 neighbor = clamp(here - ivec2(focus.texel[i].xy), ivec2(0), last);
        vec4 light = texelFetch(far_light, neighbor, 0);
        vec4 kernels = texelFetch(far_kernels, neighbor, 0);
        vec2 by_brightness = is_fine && kernels.x > own.x ? own : kernels.xy;
        vec2 by_coverage = is_fine && kernels.z > own.x ? own : kernels.zw;
        float aperture = focus.texel[i].z;
        vec2 weight = vec2(
            kernel_coverage(by_brightness.x, aperture) * by_brightness.y,
            kernel_coverage(by_coverage.x, aperture) * by_coverage.y);
        vec2 over = is_fine ? vec2(front_weight(kernels.x, own.x), front_weight(kernels.z, own.x)) : vec2(1.0);
        front += light * (weight * over).xxxy;
        behind += light * (weight - weight * over).xxxy;
    }
    front /= max(front.a, 1.0);
    return front + (1.0 - front.a) * behind / max(behind.a, 1e-5);
}

// Weight of wide circles in a texel with a fine kernel.
float wide_weight(ivec2 here, vec2 own, float range) {
    ivec2 last = ivec2(focus.size.zw) - 1;
    float sum = 0.0;
    for (int i = 0; i < kFineTaps && focus.texel[i].z < range + 0.5; ++i) {
        ivec2 neighbor = clamp(here - ivec2(focus.texel[i].xy), ivec2(0), last);
        sum += kernel_coverage(own.x, focus.texel[i].z) * own.y * texelFetch(far_wide, neighbor, 0).a;
    }
    return sum;
}

// Light of the near layer: `wide` circles of `radius` [px], merged with fine ones of about the same radius, over the
// other fine ones, which are farther away.
vec4 gather_near(ivec2 here, float range, vec4 wide, float radius) {
    ivec2 last = ivec2(focus.size.zw) - 1;
    vec4 behind = vec4(0.0);
    for (int i = 0; i < kFineTaps && focus.texel[i].z < range + 0.5; ++i) {
        ivec2 neighbor = clamp(here + ivec2(focus.texel[i].xy), ivec2(0), last);
        vec2 kernel = texelFetch(near_kernels, neighbor, 0).xy;
        vec4 light = kernel_coverage(kernel.x, focus.texel[i].z) * kernel.y * texelFetch(near_light, neighbor, 0);
        float under = front_weight(kernel.x, 0.5 * radius);
        wide += (1.0 - under) * light;
        behind += under * light;
    }
    float covered = min(wide.a + behind.a, 1.0);  // parts of one surface with widening circles do not overlap
    wide /= max(wide.a, 1.0);
    vec4 near = wide + (1.0 - wide.a) * behind / max(behind.a, 1.0);
    return near * (covered / max(near.a, 1e-5));
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    vec2 uv = 0.5 * gl_FragCoord.xy / vec2(textureSize(far_coarse, 0));

    float fine = texelFetch(far_light, here, 0).a;
    float wide = texelFetch(far_wide, here, 0).a;
    vec2 own = texelFetch(far_kernels, here, 0).zw;
    bool is_fine = fine > wide;
    float range = fine + wide > 0.0 ? (is_fine ? own.x : 0.5 * tile.z) : -1.0;
    vec4 behind = texture(far_coarse, uv);
    float visible = is_fine ? wide_weight(here, own, behind.a > 1e-3 ? range : -1.0) : 1.0;
    behind *= visible / max(behind.a, 1e-5);
    vec4 far = gather_far(here, own, is_fine, range, behind);
    far_blurred = far.a > 1e-4 ? far * (min(4.0 * (fine + wide), 1.0) / far.a) : vec4(0.0);

    vec4 near = texture(near_coarse, uv);
    float radius = texture(near_radius, uv).r / max(near.a, 1e-5);
    near_blurred = gather_near(here, tile.x > 0.0 ? 0.5 * tile.x : -1.0, near, radius);
}
