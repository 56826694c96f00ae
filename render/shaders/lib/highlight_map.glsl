// Coordinates in textures over the unit disc, whose texture coordinates are 0.5 + 0.5 (x, y). Definition:
//   WORST_AXIS  axes along the projected normal itself, for which v is always 0, instead of HighlightBlock::blinn_axis
// Techniques: fakephong.blinn-axis, fakephong.hw-blinn

#include "lib/view.glsl"
#include "highlight_gpu.h"

UNIFORM_BLOCK(kHighlightBinding, Highlight, HighlightBlock, highlight, highlights);

vec3 unit_or(vec3 v, vec3 otherwise) {
    float squared = dot(v, v);
    return squared > 1e-12 ? v * inversesqrt(squared) : otherwise;
}

// Unit axis in the plane orthogonal to unit `normal`; the projection of the camera's right vector if the global vector
// is parallel to the normal (fakephong.blinn-axis).
vec3 plane_axis(vec3 normal, vec3 projected) {
#ifdef WORST_AXIS
    vec3 global = projected;
#else
    vec3 global = highlight.blinn_axis.xyz;
#endif
    vec3 right = normalize(view.ray_right.xyz);
    vec3 other = unit_or(right - dot(right, normal) * normal, vec3(0.0));
    return unit_or(global - dot(global, normal) * normal, other);
}

// Coordinates of unit `v` in the plane orthogonal to unit `normal`, so that 1 - x^2 - y^2 = (v.normal)^2; on the rim,
// whose texels are 0, if v points away.
vec2 plane_coordinates(vec3 v, vec3 normal) {
    float cosine = dot(v, normal);
    vec3 projected = v - cosine * normal;
    vec3 axis = plane_axis(normal, projected);
    projected = cosine > 0.0 ? projected : unit_or(projected, axis);
    return vec2(dot(axis, projected), dot(cross(normal, axis), projected));
}

// Blinn map: the normal projected along H (fakephong.blinn-map); on the rim if L = -V.
vec2 blinn_coordinates(vec3 normal, vec3 to_light, vec3 to_camera) {
    vec3 h = unit_or(to_light + to_camera, vec3(0.0));
    return h == vec3(0.0) ? vec2(1.0, 0.0) : plane_coordinates(normal, h);
}

// The same as in the vertex program of appendix B, with those of its defects that are defined (fakephong.hw-blinn):
//   HW_AXIS   the axis is not normalized
//   HW_UP     it is the world's up
//   HW_BACKS  N.H < 0 is not handled
vec2 hardware_blinn_coordinates(vec3 normal, vec3 to_light, vec3 to_camera) {
    vec3 h = unit_or(to_light + to_camera, vec3(0.0));
    float n_h = dot(normal, h);
    vec3 projected = normal - n_h * h;
#ifdef HW_UP
    vec3 axis = vec3(0.0, 1.0, 0.0) - h.y * h;
#ifndef HW_AXIS
    axis = unit_or(axis, vec3(0.0));
#endif
#else
    vec3 axis = plane_axis(h, projected);
#ifdef HW_AXIS
    axis = highlight.blinn_axis.xyz - dot(highlight.blinn_axis.xyz, h) * h;
#endif
#endif
#ifndef HW_BACKS
    projected = n_h > 0.0 ? projected : unit_or(projected, axis);
#endif
    return vec2(dot(axis, projected), dot(cross(h, axis), projected));
}

// The view direction mirrored at the surface, in the camera's axes (fakephong.envmap): independent of lights.
vec3 mirrored_view(vec3 normal, vec3 to_camera) {
    vec3 w = 2.0 * dot(normal, to_camera) * normal - to_camera;
    return vec3(dot(w, normalize(view.ray_right.xyz)), dot(w, normalize(view.ray_up.xyz)), -dot(w, view.ray_forward.xyz));
}
