// All attributes of mesh vertices, for the stages that pass them on to an evaluation stage (lib/vertex_input.glsl).

#define MESH_ATTRIBUTES(ONE)        \
    ONE(0, vec3, position_ms)       \
    ONE(1, vec3, normal_ms)         \
    ONE(2, vec4, tangent_ms)        \
    ONE(3, vec2, first_uv)          \
    ONE(4, vec4, color)             \
    ONE(5, vec4, world_row0)        \
    ONE(6, vec4, world_row1)        \
    ONE(7, vec4, world_row2)        \
    ONE(8, uvec4, instance)         \
    ONE(9, vec4, previous_row0)     \
    ONE(10, vec4, previous_row1)    \
    ONE(11, vec4, previous_row2)    \
    ONE(12, vec3, previous_position_ms) \
    ONE(13, vec2, second_uv)        \
    ONE(14, vec4, wrinkle)          \
    ONE(15, float, fold_height)
