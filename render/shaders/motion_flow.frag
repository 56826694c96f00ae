// One step of optic-flow motion blur: blends the image half and half with itself warped along the field.
#version 450
#include "fullscreen_gpu.h"
#include "motion_modes_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D image;
layout(binding = kFlowUnit) uniform sampler2D field_map;

uniform float scale;  // of the field; negative: against it

layout(location = 0) out vec4 mixed;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 field = texelFetch(field_map, pixel, 0).xy;
    mixed = texelFetch(image, pixel, 0);
    if (field != vec2(0.0)) {
        vec2 from = (gl_FragCoord.xy - scale * field) / vec2(textureSize(image, 0));
        mixed = mix(mixed, textureLod(image, from, 0.0), 0.5);
    }
}
