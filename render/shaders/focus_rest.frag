// A quarter of the picture without its highlights: texels so much brighter than the light around them that a few taps
// could not make discs of them. What is taken off here is drawn by focus_disc.vert.
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

vec4 without_highlight(vec4 light, float radius, vec2 uv, int layer) {
    radius /= max(light.a, 1e-5);
    float level = log2(max(radius, 2.0));  // of texels of 4 px, two discs wide
    vec4 means = textureLod(mean_luminance, uv, level);
    float around = light.a * (layer == 0 ? means.x / max(means.y, 1e-5) : means.z / max(means.w, 1e-5));
    float texels = focus.aperture.z * radius * radius / 16.0;
    float most = around * max(2.0, kVisible * texels);
    float luminance = luminance_of(light.rgb);
    // Nothing up to `most`; of what is twice as bright, all but what is around.
    float rest = luminance > most ? max(2.0 * most - luminance, around) : luminance;
    return vec4(light.rgb * (rest / max(luminance, 1e-20)), light.a);
}

void main() {
    vec2 uv = 2.0 * gl_FragCoord.xy / focus.size.zw;
    radii = texture(light_radii, uv).xy;
    far_rest = without_highlight(texture(far_light, uv), radii.x, uv, 0);
    near_rest = without_highlight(texture(near_light, uv), radii.y, uv, 1);
    behind = texture(behind_near, uv);
}
