// Light that a mirror reflects to a plane: additive, in the projected triangles.
#version 450

uniform vec3 color;
uniform float even;  // 1: of an even color, for wires

layout(location = 0) in float lit;
layout(location = 1) in float dark;
layout(location = 0) out vec4 radiance;

void main() {
    // A triangle with a vertex that faces away would spread across the plane.
    radiance = vec4(dark > 0.0 ? vec3(0.0) : color * (even > 0.0 ? 1.0 : lit), 0.0);
}
