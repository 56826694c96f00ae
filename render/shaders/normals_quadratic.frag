// Normals whose components are quadratic over a triangle, not renormalized (fakephong.normal-interp-variants, after
// van Overveld and Wyvill, "Phong Normal Interpolation Revisited", 1997).
// Techniques: fakephong.normal-interp-variants
#version 450
#include "lib/facet_normal.glsl"

void main() {
    float basis[6] = quadratic_basis(st);
    vec3 normal = basis[0] * facet_normals[0];
    for (int i = 1; i < 6; ++i) {
        normal += basis[i] * facet_normals[i];
    }
    radiance = radiance_by(normal);
}
