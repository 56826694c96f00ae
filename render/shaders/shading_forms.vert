// A ball of quads, gl_VertexID alone, for `limn bench forms`: the same image by dearer and cheaper forms of its shader.
// Definitions:
//   OBJECT_CONSTANTS  matrices of the object come multiplied from the CPU
//   LIGHT_PER_VERTEX  the vector to the light is interpolated; else it is computed per pixel
//   UNIT_LIGHT        it is normalized before that, which is wrong
// Techniques: engine.opt-cpu-const, engine.opt-frag-move
#version 450

const int kQuads = 96;  // along a side
const float kPi = 3.14159265;

uniform mat4 world_from_object;
uniform mat4 clip_from_world;
uniform mat4 clip_from_object;
uniform mat3 normal_matrix;
uniform vec3 light;  // in world space

layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec3 tangent;
layout(location = 3) out vec3 bitangent;
layout(location = 4) out vec3 to_light;

void main() {
    int quad = gl_VertexID / 6;
    int corner = gl_VertexID % 6;
    ivec2 at = ivec2(quad % kQuads, quad / kQuads) + ivec2(corner == 1 || corner == 2 || corner == 4, corner == 2 || corner == 4 || corner == 5);
    vec2 angle = vec2(2.0 * kPi, kPi) * vec2(at) / float(kQuads);
    vec3 n = vec3(sin(angle.y) * cos(angle.x), cos(angle.y), sin(angle.y) * sin(angle.x));
    vec3 t = vec3(-sin(angle.x), 0.0, cos(angle.x));
    vec4 object_position = vec4(n, 1.0);
#ifdef OBJECT_CONSTANTS
    gl_Position = clip_from_object * object_position;
    mat3 frame = normal_matrix;
#else
    gl_Position = clip_from_world * (world_from_object * object_position);
    mat3 frame = transpose(inverse(mat3(world_from_object)));
#endif
    world_position = (world_from_object * object_position).xyz;
    normal = frame * n;
    tangent = mat3(world_from_object) * t;
    bitangent = cross(normal, tangent);
#ifdef LIGHT_PER_VERTEX
    to_light = light - world_position;
#ifdef UNIT_LIGHT
    to_light = normalize(to_light);
#endif
#else
    to_light = vec3(0.0);
#endif
}
