// The curvature of a mesh along one direction: red convex, green flat, blue concave.
// Techniques: relief.curvature-view
#version 450

layout(location = 11) in vec2 relief_curvature;  // along tangent and bitangent [1/m]
layout(location = 0) out vec4 radiance;
uniform vec2 axis;
uniform float full;  // curvature of full red or blue [1/m]

void main() {
    float k = dot(relief_curvature, axis) / full;
    radiance = vec4(mix(vec3(0.0, 1.0, 0.0), k > 0.0 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 0.0, 1.0), min(abs(k), 1.0)), 1.0);
}
