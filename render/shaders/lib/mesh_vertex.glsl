// Inputs and transforms of vertex shaders of mesh instances, or of the evaluation stage of tessellated ones. Definitions
// of lib/vertex_input.glsl, and
//   INFLATE  vertices move along their normals
// Hooks move vertices, too (render/material/surface_hooks.h).
// Techniques: bump.tangent-space, shade.lighting-space

#include "lib/inflate.glsl"
#include "lib/vertex_input.glsl"

VERTEX_INPUT(0, vec3, position_ms);
VERTEX_INPUT(1, vec3, normal_ms);
VERTEX_INPUT(2, vec4, tangent_ms);  // w: sign of the bitangent
VERTEX_INPUT(3, vec2, first_uv);
VERTEX_INPUT(4, vec4, color);
INSTANCE_INPUT(5, vec4, world_row0);  // world_from_mesh
INSTANCE_INPUT(6, vec4, world_row1);
INSTANCE_INPUT(7, vec4, world_row2);
INSTANCE_INPUT(8, uvec4, instance);  // material, flags, index; w: bits of the inflation distance
VERTEX_INPUT(13, vec2, second_uv);

#include "generated/position_hooks.glsl"

// The position after hooks and inflation.
vec3 moved_vertex(vec3 position) {
    hook_position(position);
#ifdef INFLATE
    return inflate(position, normal_ms, uintBitsToFloat(instance.w));
#else
    return position;
#endif
}

vec3 vertex_ms() {
    return moved_vertex(position_ms);
}

vec3 vertex_ws() {
    vec4 p = vec4(vertex_ms(), 1.0);
    return vec3(dot(world_row0, p), dot(world_row1, p), dot(world_row2, p));
}

// -1 for mirrored instances.
float vertex_side() {
    return (instance.y & 1u) != 0u ? -1.0 : 1.0;
}

// Unit. Normals transform by the cofactor matrix (the inverse transpose times the determinant, whose sign is removed),
// whose rows are the cross products of the rows.
vec3 vertex_normal_ws() {
    vec3 n = vertex_side() * vec3(
        dot(cross(world_row1.xyz, world_row2.xyz), normal_ms),
        dot(cross(world_row2.xyz, world_row0.xyz), normal_ms),
        dot(cross(world_row0.xyz, world_row1.xyz), normal_ms));
    return n * inversesqrt(max(dot(n, n), 1e-30));
}
