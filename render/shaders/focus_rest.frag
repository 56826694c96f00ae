// A quarter of the picture, its coarse circles alone, without their highlights: texels so much brighter than the light
// around them that a few taps could not make discs of them. What is taken off here is drawn by focus_disc.vert.
#version 450
#include "lib/focus.glsl"

layout(binding = 0) uniform sampler2D far_light;
layout(binding = 1) uniform sampler2D near_light;
layout(binding = 2) uniform sampler2D light_radii;
layout(binding = 3) uniform sampler2D behind_near;
layout(binding = 4) uniform sampler2D mean_luminance;

layout(location = 0) out vec4 far_rest;
layout(location = 1) out vec4 near_rest;
layout(location = 2) out vec2 radii;
layout(location = 3) out vec4 behind;

const float kVisible = 0.06;  // of the light around, what a disc adds to it at least; by eye

vec4 without_highlight(vec4 light, inout float weighed_radius, vec2 uv) {
    float radius = weighed_radius / max(radius_weight(light), 1e-20);
    float level = log2(max(radius, 2.0));  // of texels of 4 px, two discs wide
    vec2 mean = textureLod(mean_luminance, uv, level).xy;
    float around = light.a * mean.x / max(mean.y, 1e-5);
    float texels = focus.aperture.z * radius * radius / 16.0;
    float most = around * max(2.0, kVisible * texels);
    float luminance = luminance_of(light.rgb);
    // Nothing up to `most`; of what is twice as bright, all but what is around.
    float rest = luminance > most ? max(2.0 * most - luminance, around) : luminance;
    light.rgb *= rest / max(luminance, 1e-20);
    weighed_radius = radius * radius_weight(light);
    return light;
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    vec2 uv = 2.0 * gl_FragCoord.xy / focus.size.zw;
    float far_radius;
    float near_radius;
    vec4 far = coarse_mean(far_light, light_radii, 0, here, far_radius);
    vec4 near = coarse_mean(near_light, light_radii, 1, here, near_radius);
    far_rest = without_highlight(far, far_radius, uv);
    near_rest = without_highlight(near, near_radius, uv);
    radii = vec2(far_radius, near_radius);
    behind = texture(behind_near, uv);
}
