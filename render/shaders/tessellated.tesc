// How finely a triangle of a displaced mesh is divided: into edges of Material::tessellation pixels. What an edge is
// divided into depends on it alone, and on how far it is from the eye, not on where the eye looks: triangles that share it
// agree, and so do the passes of a view, with its shadow maps. Definitions of lib/material_maps.glsl, and
//   SMALL_PATCHES  llvmpipe (Mesa 22.3) counts the vertices of 1024 indices with 16 bits
// Techniques: tex.displacement
#version 450
#include "lib/material_maps.glsl"
#include "lib/mesh_attributes.glsl"
#include "lib/view.glsl"
#include "relief_gpu.h"

layout(vertices = 3) out;

#define ATTRIBUTE(at, type, name)               \
    layout(location = at) in type name##_in[]; \
    layout(location = at) out type name[];
#define COPY(at, type, name) name[gl_InvocationID] = name##_in[gl_InvocationID];

MESH_ATTRIBUTES(ATTRIBUTE)
layout(location = 16) patch out vec3 relief_texels;  // of the map along each edge, opposite to the corner

// Of edges that are longer, parts are longer, too: meshes need triangles of a decent size.
#ifdef SMALL_PATCHES
const float kMaxLevel = 15.0;
#else
const float kMaxLevel = 64.0;
#endif

vec3 corner_ws(int i) {
    vec4 p = vec4(position_ms_in[i], 1.0);
    return vec3(dot(world_row0_in[0], p), dot(world_row1_in[0], p), dot(world_row2_in[0], p));
}

float edge_level(vec3 a, vec3 b, float pixels) {
    float range = max(distance(0.5 * (a + b), view.tessellation.xyz), 1e-4);
    return clamp(distance(a, b) * view.tessellation.w / (range * pixels), 1.0, kMaxLevel);
}

float edge_texels(int a, int b) {
    float texels = 0.0;
#ifdef RELIEF_MAP
    vec4 along = vec4(first_uv_in[a], second_uv_in[a]) - vec4(first_uv_in[b], second_uv_in[b]);
    vec2 size = vec2(textureSize(material_maps[RELIEF_MAP], 0).xy);
    texels = length(map_coordinates(instance_in[0].x, kReliefSlot, along, 0.0) * size);
#endif
    return texels;
}

// Beyond one side of the image, by more than `depth`, the farthest that vertices are moved.
bool is_outside(vec4 a, vec4 b, vec4 c, float depth) {
    mat4 rows = transpose(view.clip_from_world);
    for (int axis = 0; axis < 2; ++axis) {
        for (float side = -1.0; side < 2.0; side += 2.0) {
            float margin = depth * length(rows[3].xyz - side * rows[axis].xyz);
            vec3 inside = vec3(a.w - side * a[axis], b.w - side * b[axis], c.w - side * c[axis]);
            if (all(lessThan(inside, vec3(-margin)))) {
                return true;
            }
        }
    }
    return false;
}

void main() {
    MESH_ATTRIBUTES(COPY)
    if (gl_InvocationID != 0) {
        return;
    }
    vec4 relief = block_texel(instance_in[0].x, kReliefBlock, 0);
    vec3 a = corner_ws(0);
    vec3 b = corner_ws(1);
    vec3 c = corner_ws(2);
    vec3 level = vec3(edge_level(b, c, relief.w), edge_level(c, a, relief.w), edge_level(a, b, relief.w));
    float scale = length(world_row0_in[0].xyz) + length(world_row1_in[0].xyz) + length(world_row2_in[0].xyz);
    bool outside = is_outside(
        view.clip_from_world * vec4(a, 1.0), view.clip_from_world * vec4(b, 1.0), view.clip_from_world * vec4(c, 1.0),
        relief.x * scale);
    gl_TessLevelOuter[0] = outside ? 0.0 : level.x;
    gl_TessLevelOuter[1] = outside ? 0.0 : level.y;
    gl_TessLevelOuter[2] = outside ? 0.0 : level.z;
    gl_TessLevelInner[0] = max(level.x, max(level.y, level.z));
    relief_texels = vec3(edge_texels(1, 2), edge_texels(2, 0), edge_texels(0, 1));
}
