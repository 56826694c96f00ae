// White faces lit from the eye, or the height of furrows (furrow_pass.h).
// Techniques: wrinkle.furrow.view-modes
#version 450
#include "lib/scene_hides.glsl"
#include "furrow_gpu.h"

layout(binding = kFurrowHeightsUnit) uniform sampler2D heights;

layout(location = 0) in vec3 position_ms;
layout(location = 1) in vec2 uv;
layout(location = 0) out vec4 display;

uniform vec3 eye;          // in mesh space
uniform int shows_height;  // 0: white

const float kMinWhite = 0.45;  // brightness of faces viewed edge-on; by eye

void main() {
    if (scene_hides(gl_FragCoord.xyz)) {
        discard;
    }
    if (shows_height != 0) {
        display = vec4(vec3(texture(heights, uv).r), 1.0);
        return;
    }
    vec3 normal = normalize(cross(dFdx(position_ms), dFdy(position_ms)));
    float facing = abs(dot(normal, normalize(eye - position_ms)));
    display = vec4(vec3(mix(kMinWhite, 1.0, facing)), 1.0);
}
