// Lines from the corners of a triangle along their tangent, bitangent and normal.
// Techniques: bump.frame-view
#version 450
#include "lib/view.glsl"

layout(triangles) in;
layout(line_strip, max_vertices = 18) out;

layout(location = 0) in vec3 normal_ws[];
layout(location = 1) in vec4 tangent_ws[];
uniform float axis_length;  // [m]

layout(location = 0) out vec3 axis_color;

const float kNearer = 1.004;  // factor of the reversed depth, so that lines along the surface are seen

void put_line(int corner, vec3 axis, vec3 color) {
    vec4 from = gl_in[corner].gl_Position;
    vec4 to = from + view.clip_from_world * vec4(axis * axis_length, 0.0);
    gl_Position = vec4(from.xy, from.z * kNearer, from.w);
    axis_color = color;
    EmitVertex();
    gl_Position = vec4(to.xy, to.z * kNearer, to.w);
    axis_color = color;
    EmitVertex();
    EndPrimitive();
}

void main() {
    for (int i = 0; i < 3; ++i) {
        vec3 normal = normal_ws[i];
        put_line(i, normal, vec3(1.0, 0.0, 0.0));
        vec3 tangent = tangent_ws[i].xyz;
        if (dot(tangent, tangent) > 0.25) {
            put_line(i, tangent, vec3(0.0, 1.0, 0.0));
            put_line(i, tangent_ws[i].w * cross(normal, tangent), vec3(0.0, 0.0, 1.0));
        }
    }
}
