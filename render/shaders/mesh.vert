// Every mesh instance, for the G-buffer and for the passes that shade while drawing.
//   VELOCITY  also where each point was the moment before
//   INFLATE  vertices move along their normals
//   OBJECT_LIGHTS  also the instance's place
#version 450
#include "lib/inflate.glsl"
#include "lib/view.glsl"

layout(location = 0) in vec3 position_ms;
layout(location = 1) in vec3 normal_ms;
layout(location = 2) in vec4 tangent_ms;  // w: sign of the bitangent
layout(location = 3) in vec4 uvs;         // both sets
layout(location = 4) in vec4 color;
layout(location = 5) in vec4 world_row0;  // world_from_mesh
layout(location = 6) in vec4 world_row1;
layout(location = 7) in vec4 world_row2;
layout(location = 8) in uvec4 instance;   // material, flags, place; w: bits of the distance to inflate by
layout(location = 9) in vec4 before_row0;
layout(location = 10) in vec4 before_row1;
layout(location = 11) in vec4 before_row2;

layout(location = 0) out vec3 normal_ws;   // not unit
layout(location = 1) out vec4 tangent_ws;  // w: sign of the bitangent
layout(location = 2) out vec4 uv;
layout(location = 3) out vec4 vertex_color;
layout(location = 4) flat out uvec2 material_and_flags;
#ifdef VELOCITY
layout(location = 5) out vec3 before;  // clip x, y, w
#endif
#ifdef OBJECT_LIGHTS
layout(location = 6) flat out uint object;
#endif
invariant gl_Position;  // passes that draw again what is nearest ask for the same depth

void main() {
    vec4 p = vec4(position_ms, 1.0);
#ifdef INFLATE
    p.xyz = inflate(position_ms, normal_ms, uintBitsToFloat(instance.w));
#endif
    vec3 position_ws = vec3(dot(world_row0, p), dot(world_row1, p), dot(world_row2, p));
    gl_Position = view.clip_from_world * vec4(position_ws, 1.0);

    // Normals go by the cofactor matrix, the inverse transpose times the determinant, whose sign is taken out:
    // its rows are the cross products of the rows.
    float side = (instance.y & 1u) != 0u ? -1.0 : 1.0;
    normal_ws = side * vec3(
        dot(cross(world_row1.xyz, world_row2.xyz), normal_ms),
        dot(cross(world_row2.xyz, world_row0.xyz), normal_ms),
        dot(cross(world_row0.xyz, world_row1.xyz), normal_ms));
    normal_ws *= inversesqrt(max(dot(normal_ws, normal_ws), 1e-30));

    vec3 t = vec3(dot(world_row0.xyz, tangent_ms.xyz), dot(world_row1.xyz, tangent_ms.xyz), dot(world_row2.xyz, tangent_ms.xyz));
    tangent_ws = vec4(t * inversesqrt(max(dot(t, t), 1e-30)), tangent_ms.w * side);
    uv = uvs;
    vertex_color = color;
    material_and_flags = instance.xy;
#ifdef OBJECT_LIGHTS
    object = instance.z;
#endif

#ifdef VELOCITY
    vec4 q = vec4(dot(before_row0, p), dot(before_row1, p), dot(before_row2, p), 1.0);
    before = (view.previous_from_world * q).xyw;
#endif
}
