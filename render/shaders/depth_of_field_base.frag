// Base layers: coarse circles at quarter resolution, without highlights, which are texels so much brighter than their
// surroundings that a few taps could not render their discs. depth_of_field_disc.vert draws the removed light.
#version 450
#include "lib/depth_of_field.glsl"
#include "depth_of_field_gpu.h"

layout(binding = kFocusFarWideUnit) uniform sampler2D far_wide;
layout(binding = kFocusNearWideUnit) uniform sampler2D near_wide;
layout(binding = kFocusWideRadiiUnit) uniform sampler2D wide_radii;
layout(binding = kFocusBehindNearUnit) uniform sampler2D behind_near;
layout(binding = kFocusLuminanceUnit) uniform sampler2D mean_luminance;

layout(location = 0) out vec4 far_base;
layout(location = 1) out vec4 near_base;
layout(location = 2) out vec2 radii;
layout(location = 3) out vec4 behind;

const float kVisible = 0.06;  // minimum light of a disc relative to its surroundings; by eye

vec4 without_highlight(vec4 light, inout float weighted_radius, vec2 uv) {
    float radius = weighted_radius / max(radius_weight(light), 1e-20);
    float level = log2(max(radius, 2.0));  // of texels of 4 px, two discs wide
    vec2 mean = textureLod(mean_luminance, uv, level).xy;
    float surroundings = light.a * mean.x / max(mean.y, 1e-5);
    float texels = focus.aperture.z * radius * radius / 16.0;
    float limit = surroundings * max(2.0, kVisible * texels);
    float luminance = luminance_of(light.rgb);
    // Removes nothing up to `limit`; from twice that brightness on, all light above the surroundings.
    float kept = luminance > limit ? max(2.0 * limit - luminance, surroundings) : luminance;
    light.rgb *= kept / max(luminance, 1e-20);
    weighted_radius = radius * radius_weight(light);
    return light;
}

void main() {
    vec2 uv = 2.0 * gl_FragCoord.xy / focus.size.zw;  // between four texels
    radii = texture(wide_radii, uv).xy;
    far_base = without_highlight(texture(far_wide, uv), radii.x, uv);
    near_base = without_highlight(texture(near_wide, uv), radii.y, uv);
    behind = texture(behind_near, uv);
}
