// A shadow volume: every corner of a caster's triangles stays where it is or is extruded away from the light
// (shadow.vol-extrude).
//   PRISMS  one volume per triangle: the corner holds its cap; else it depends on whether its triangle faces the light
//           (shadow.vol-per-edge)
// Techniques: shadow.relief-stencil, shadow.vol-extrude, shadow.vol-per-edge, shadow.vol-per-triangle
#version 450
#include "lib/view.glsl"
#include "shadow_volume_gpu.h"

layout(binding = kShadowVolumeBinding, std140) uniform Volume {
    VolumeBlock volume;
};

layout(location = 0) in vec4 corner;      // mesh space; w: 1 = far cap
layout(location = 1) in vec4 plane;       // of its triangle, mesh space
layout(location = 2) in vec4 world_row0;  // world_from_mesh
layout(location = 3) in vec4 world_row1;
layout(location = 4) in vec4 world_row2;
layout(location = 5) in vec4 light;       // mesh space, homogeneous
layout(location = 6) in vec4 relief;      // x: depth [m]

// Unit, of the corner's triangle. Planes transform by the cofactor matrix.
vec3 plane_normal() {
    vec3 normal_ws = vec3(
        dot(cross(world_row1.xyz, world_row2.xyz), plane.xyz),
        dot(cross(world_row2.xyz, world_row0.xyz), plane.xyz),
        dot(cross(world_row0.xyz, world_row1.xyz), plane.xyz));
    return normal_ws * inversesqrt(max(dot(normal_ws, normal_ws), 1e-30));
}

// Distance of the light from the plane of the corner's triangle [m].
float light_height(vec3 position_ws) {
    return abs(dot(plane_normal(), volume.light.xyz - position_ws));
}

float near_shift(vec3 position_ws) {
#ifdef PRISMS
    float cosine = abs(dot(plane_normal(), normalize(away_from_light(position_ws, volume.light))));
#else
    float cosine = kSharedPushCosine;
#endif
    return volume.extrusion.z + relief_push(relief.x, cosine);
}

void main() {
    vec4 p = vec4(corner.xyz, 1.0);
    vec3 position_ws = vec3(dot(world_row0, p), dot(world_row1, p), dot(world_row2, p));
    bool lit = dot(plane, light) > 0.0;
#ifdef PRISMS
    bool far = corner.w > 0.5;
#else
    bool far = !lit;
#endif
    vec4 moved = far ? extrude_corner(position_ws, volume.light, volume.extrusion, light_height(position_ws))
                     : vec4(shift_from_light(position_ws, volume.light, near_shift(position_ws)), 1.0);
    gl_Position = view.clip_from_world * moved;
#ifdef PRISMS
    gl_Position = lit ? gl_Position : vec4(0.0, 0.0, 0.0, 1.0);  // no area
#endif
}
