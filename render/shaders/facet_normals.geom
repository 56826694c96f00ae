// The normals of corners and midpoints of each triangle (fakephong.normal-interp-variants), lit per pixel.
// Techniques: fakephong.normal-interp-variants
#version 450
#include "lib/facet_point.glsl"

layout(location = 1) out vec3 position_ws;
layout(location = 6) flat out uint object;
layout(location = 9) flat out vec3 facet_normals[7];  // unit: around the triangle, then the face normal

void main() {
    vec3 normals[7];
    for (int i = 0; i < 6; ++i) {
        normals[i] = mesh_point(kSixPoints[i]).normal_ws;
    }
    normals[6] = face_normal_ws();
    for (int i = 0; i < 3; ++i) {
        put_corner(i);
        position_ws = corner_ws[i];
        object = corner_instance[i].z;
        facet_normals = normals;
        EmitVertex();
    }
    EndPrimitive();
}
