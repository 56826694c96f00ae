// Quadratic shading as the vertex program of the thesis's appendix A computes it (fakephong.hw-quadratic). Like lit(),
// it has no highlights where N.L <= 0. Definitions, its defects:
//   HW_FIRST_LIGHT  only the first light
//   HW_MIDPOINTS    normals of midpoints are normalized before the mesh is rotated and scaled, not after
// SINGLE_LIGHTS: lib/single_lights.glsl, unused here.
// Techniques: fakephong.hw-quadratic
#version 450
#include "lib/facet_point.glsl"
#include "lib/single_lights.glsl"

#ifdef HW_MIDPOINTS
layout(location = 5) in vec3 corner_normal_ms[];
layout(location = 6) in vec3 corner_scaled_normal[];  // the same, rotated and scaled
#endif

layout(location = 9) flat out vec3 sampled[12];

MeshPoint hardware_point(int i) {
    MeshPoint p = mesh_point(kSixPoints[i]);
#ifdef HW_MIDPOINTS
    if (i % 2 == 1) {
        int a = i / 2;
        int b = (a + 1) % 3;
        vec3 sum = corner_normal_ms[a] + corner_normal_ms[b];
        if (dot(sum, sum) > 1e-12) {
            p.normal_ws = (corner_scaled_normal[a] + corner_scaled_normal[b]) * inversesqrt(dot(sum, sum));
        }
    }
#endif
    return p;
}

void main() {
    int end = kEveryLight;
#ifdef HW_FIRST_LIGHT
    end = 1;
#endif
    vec3 light[12];
    for (int i = 0; i < 6; ++i) {
        Reflected r = light_from(lit_point(hardware_point(i)), 0, 0, end);
        light[2 * i] = r.diffuse;
        light[2 * i + 1] = r.specular;
    }
    for (int i = 0; i < 3; ++i) {
        put_corner(i);
        sampled = light;
        EmitVertex();
    }
    EndPrimitive();
}
