// One axis of a tangent frame.
// Techniques: bump.frame-view
#version 450

layout(location = 0) in vec3 axis_color;
layout(location = 0) out vec4 radiance;

void main() {
    radiance = vec4(axis_color, 1.0);
}
