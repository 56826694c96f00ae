// The ball of shading_forms.vert: red is the light's diffuse share, green and blue its angles about the tangent frame.
// Definitions:
//   LIGHT_PER_VERTEX  as in shading_forms.vert
//   ONE_NORMALIZE     one square root for the tangent space instead of four
//   ANGLE_TABLE       angles from a texture instead of acos
// Techniques: engine.opt-frag-move, engine.opt-lut, engine.opt-normalise
#version 450
#include "lib/acos_table.glsl"
#include "lib/tangent_space.glsl"

uniform vec3 light;

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 tangent;
layout(location = 3) in vec3 bitangent;
layout(location = 4) in vec3 to_light;
layout(location = 0) out vec4 color;

void main() {
#ifdef LIGHT_PER_VERTEX
    vec3 l = to_light;
#else
    vec3 l = light - world_position;
#endif
#ifdef ONE_NORMALIZE
    vec3 local = to_tangent_space(l, tangent, bitangent, normal);
#else
    vec3 local = to_tangent_space_exact(l, tangent, bitangent, normal);
#endif
#ifdef ANGLE_TABLE
    vec2 angles = angles_from_table(local.x, local.y);
#else
    vec2 angles = angles_by_arithmetic(local.x, local.y);
#endif
    color = vec4(max(local.z, 0.0), angles / 3.14159265, 1.0);
}
