// A rectangle on screen: a strip of four corners, without vertex data.
#version 450

uniform vec4 rect;  // NDC: lower left, upper right corner

void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(mix(rect.xy, rect.zw, corner), 0.0, 1.0);
}
