// A pixel of a triangle that facet_normals.geom has prepared. Include first.
#include "lib/lighting.glsl"
#include "lib/facet_pixel.glsl"
#include "lib/light_at.glsl"

layout(location = 1) INTERPOLATED in vec3 position_ws;
layout(location = 6) flat in uint object;
layout(location = 9) flat in vec3 facet_normals[7];

// Light that the pixel reflects with this normal, which need not be unit.
vec4 radiance_by(vec3 normal) {
    Reflected light = light_at(MeshPoint(position_ws, normal, vertex_color, material_and_flags, object));
    return facet_radiance(mat2x3(light.diffuse, light.specular));
}
