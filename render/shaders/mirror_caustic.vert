// A mirror's vertices, projected to where they reflect the light (lib/caustic_landing.glsl).
// Techniques: caustic.reflection-plane
#version 450
#include "lib/caustic_landing.glsl"
#include "lib/view.glsl"

layout(location = 0) in vec3 position_ms;
layout(location = 1) in vec3 normal_ms;

uniform vec4 row_x;  // world_from_mesh
uniform vec4 row_y;
uniform vec4 row_z;
uniform vec4 light;  // position and 1, or the direction toward it and 0
uniform vec4 plane;
uniform vec4 look;   // mirror_vertex()

layout(location = 0) out float lit;
layout(location = 1) out float dark;  // > 0 in triangles with an unlit vertex

const float kNearer = 1.0005;  // depth bias toward the camera, relative to the plane that it lies on

void main() {
    vec4 p = vec4(position_ms, 1.0);
    vec3 normal = vec3(
        dot(cross(row_y.xyz, row_z.xyz), normal_ms),
        dot(cross(row_z.xyz, row_x.xyz), normal_ms),
        dot(cross(row_x.xyz, row_y.xyz), normal_ms));
    vec3 vertex = vec3(dot(row_x, p), dot(row_y, p), dot(row_z, p));
    vec4 moved = mirror_vertex(vertex, normal * inversesqrt(max(dot(normal, normal), 1e-30)), light, plane, look);
    lit = max(moved.w, 0.0);
    dark = moved.w < 0.0 ? 1.0 : 0.0;
    gl_Position = view.clip_from_world * vec4(moved.xyz, 1.0);
    gl_Position.z *= kNearer;
}
