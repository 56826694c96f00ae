// The offset of motion_flow.vert in screen space [px].
#version 450
#include "lib/motion.glsl"
#include "lib/view.glsl"

uniform float exposure;  // fraction of the frame time
uniform float longest;   // [px]

layout(location = 0) in vec3 tail;
layout(location = 0) out vec2 field;

void main() {
    vec2 now_ndc = gl_FragCoord.xy * view.size.zw * 2.0 - 1.0;
    vec2 offset = 0.5 * (now_ndc - tail.xy / max(tail.z, 1e-6)) * view.size.xy * exposure;
    // Less is rounding error of a static point.
    field = dot(offset, offset) < 1e-4 ? vec2(0.0) : bounded_motion(offset, longest);
}
