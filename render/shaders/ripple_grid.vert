// The offset of post.scene-ripple, per vertex of a grid over the image, with two triangles per cell.
#version 450
#include "lib/ripple.glsl"

uniform int points;  // per side
uniform vec2 center;
uniform float radius;
uniform float amplitude;
uniform float aspect;

layout(location = 0) out vec2 shift_uv;

void main() {
    int cell = gl_VertexID / 6;
    int corner = gl_VertexID % 6;
    ivec2 step = ivec2(corner == 1 || corner == 2 || corner == 4 ? 1 : 0, corner == 2 || corner == 4 || corner == 5 ? 1 : 0);
    vec2 uv = vec2(ivec2(cell % (points - 1), cell / (points - 1)) + step) / float(points - 1);
    shift_uv = screen_ripple(uv, center, radius, amplitude, aspect);
    gl_Position = vec4(2.0 * uv - 1.0, 0.0, 1.0);
}
