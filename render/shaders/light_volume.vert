// Coarse bounding mesh of a light's volume: a ball around a point light, or with the definition
//   CONE  a pyramid around a spot's cone
// Without vertex data: gl_VertexID enumerates the corners of triangles, counterclockwise from outside.
// Techniques: deferred.light-volume, light.volume-stencil
#version 450
#include "lib/view.glsl"

uniform vec4 volume_sphere;  // position and radius of the light [m]
uniform vec4 volume_axis;    // unit; w: tangent of the cone's half angle

const float kStep = 0.785398163397448;  // eighth of a turn
// Factors that scale polygons inscribed in a circle to enclose it.
const float kWrapRing = 1.08239220029239;  // 1 / cos(half a step)
const float kWrapBall = 1.171572875253810;  // its square, for both directions

// Corner 0 .. 5 of a quad of two triangles, as steps right and up.
ivec2 quad_corner(int corner) {
    return ivec2(corner == 1 || corner == 2 || corner == 4 ? 1 : 0, corner == 2 || corner == 4 || corner == 5 ? 1 : 0);
}

#ifdef CONE
// 8 sides from the apex, 8 triangles of the base; z along the axis.
vec3 corner_of_volume(int id) {
    int side = id / 3 % 8;
    int corner = id % 3;
    bool base = id >= 24;
    float angle = kStep * float(side + (corner == (base ? 2 : 1) ? 1 : 0));
    vec3 rim = vec3(cos(angle) * volume_axis.w * kWrapRing, sin(angle) * volume_axis.w * kWrapRing, 1.0);
    vec3 tip = vec3(0.0, 0.0, base ? 1.0 : 0.0);
    return corner == 0 ? tip : rim;
}
#else
// 4 rings of 8 quads; z to the pole.
vec3 corner_of_volume(int id) {
    int quad = id / 6;
    ivec2 at = ivec2(quad % 8, quad / 8) + quad_corner(id % 6);
    float longitude = kStep * float(at.x);
    float latitude = kStep * float(at.y - 2);
    return kWrapBall * vec3(cos(latitude) * cos(longitude), cos(latitude) * sin(longitude), sin(latitude));
}
#endif

void main() {
    vec3 z = volume_axis.xyz;
    vec3 x = normalize(cross(abs(z.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), z));
    vec3 p = volume_sphere.w * corner_of_volume(gl_VertexID);
    gl_Position = view.clip_from_world * vec4(volume_sphere.xyz + p.x * x + p.y * cross(z, x) + p.z * z, 1.0);
}
