// Darkens toward the corners: cos^4 law and overlap of pupil and rim (vignette_pass.h).
#version 450
#include "fullscreen_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D scene_radiance;

uniform vec2 tangent;      // of half the field of view
uniform float natural;     // 0 .. 1
uniform float mechanical;  // shift in the corners [pupil diameters]

layout(location = 0) out vec4 radiance;

void main() {
    vec2 ndc = 2.0 * gl_FragCoord.xy / vec2(textureSize(scene_radiance, 0)) - 1.0;
    vec2 offset = ndc * tangent;
    float cos2 = 1.0 / (1.0 + dot(offset, offset));
    float d = clamp(mechanical * length(offset) / length(tangent), 0.0, 1.0);
    float pupil = 2.0 / 3.14159265 * (acos(d) - d * sqrt(1.0 - d * d));
    vec4 scene = texelFetch(scene_radiance, ivec2(gl_FragCoord.xy), 0);
    radiance = vec4((1.0 + natural * (cos2 * cos2 - 1.0)) * pupil * scene.rgb, scene.a);
}
