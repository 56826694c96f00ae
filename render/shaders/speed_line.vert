// A line as a quad that faces the camera, from SpeedLine records of three texels (speed_line_pass.h).
#version 450
#include "lib/view.glsl"
#include "speed_line_gpu.h"

layout(binding = kSpeedLinesUnit) uniform samplerBuffer lines;

layout(location = 0) out vec4 color;  // premultiplied

const vec2 kCorners[6] = vec2[](
    vec2(0.0, -1.0), vec2(0.0, 1.0), vec2(1.0, 1.0), vec2(0.0, -1.0), vec2(1.0, 1.0), vec2(1.0, -1.0));

void main() {
    int line = gl_VertexID / 6;
    vec2 corner = kCorners[gl_VertexID % 6];
    vec4 head_width = texelFetch(lines, 3 * line);
    vec4 head = view.clip_from_world * vec4(head_width.xyz, 1.0);
    vec4 tail = view.clip_from_world * vec4(texelFetch(lines, 3 * line + 1).xyz, 1.0);
    vec4 ink = texelFetch(lines, 3 * line + 2);

    // Clips at the near plane.
    float near = view.camera_ws.w;
    if (tail.w < near && head.w > near) {
        tail = mix(head, tail, (head.w - near) / (head.w - tail.w));
    }
    vec2 along = (tail.xy / max(tail.w, 1e-6) - head.xy / max(head.w, 1e-6)) * view.size.xy;
    vec2 across = vec2(-along.y, along.x) / max(length(along), 1e-6);
    vec4 place = corner.x > 0.5 ? tail : head;
    float half_width_px = 0.5 * max(head_width.w * view.size.y, 1.0);
    place.xy += corner.y * half_width_px * 2.0 * view.size.zw * across * place.w;
    gl_Position = head.w > near ? place : vec4(2.0, 2.0, 2.0, 1.0);
    float opacity = ink.a * (1.0 - corner.x);
    color = vec4(ink.rgb * opacity, opacity);
}
