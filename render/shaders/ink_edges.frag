// Edges between a pixel and its right (x) and its lower neighbor (y): 1 where the surface ends, folds or changes its
// material (ink_lines_pass.h).
// Techniques: tex.ink-lines
#version 450
#define MATERIAL_RECORDS
#include "lib/stored_surface.glsl"
#include "lib/view.glsl"

uniform float depth_threshold;   // fraction of the distance to the camera
uniform float least_cosine;      // between normals of one surface
uniform int between_materials;

layout(location = 0) out vec2 edges;

struct InkPoint {
    vec3 position_ws;
    vec3 normal_ws;
    float distance;  // along the view axis [m]; 0: background
    uint material;
};

InkPoint ink_point(ivec2 pixel) {
    float depth = texelFetch(scene_depth, pixel, 0).r;
    InkPoint p;
    p.distance = depth > 0.0 ? view_distance(depth) : 0.0;
    p.position_ws = world_position(vec2(pixel) + 0.5, max(depth, 1e-12));
    p.normal_ws = unpack_direction(texelFetch(gbuffer, pixel, 0).x);
    p.material = texelFetch(gbuffer_material, pixel, 0).r;
    return p;
}

float edge_between(InkPoint a, InkPoint b) {
    vec3 offset = b.position_ws - a.position_ws;
    // The larger distance, since one of the planes may happen to pass through the other point.
    float step_height = max(abs(dot(offset, a.normal_ws)), abs(dot(offset, b.normal_ws)));
    bool ends = step_height > depth_threshold * min(a.distance, b.distance);
    bool folds = dot(a.normal_ws, b.normal_ws) < least_cosine;
    bool changes = between_materials != 0 && a.material != b.material;
    bool both = a.distance > 0.0 && b.distance > 0.0;
    bool either = a.distance > 0.0 || b.distance > 0.0;
    return (both ? ends || folds || changes : either) ? 1.0 : 0.0;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(scene_depth, 0) - 1;
    InkPoint here = ink_point(pixel);
    edges.x = edge_between(here, ink_point(min(pixel + ivec2(1, 0), last)));
    edges.y = edge_between(here, ink_point(min(pixel + ivec2(0, 1), last)));
}
