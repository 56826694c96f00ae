// Corners of a mesh on which furrows are visualized (furrow_pass.h).
#version 450
#include "furrow_gpu.h"

layout(binding = kFurrowVerticesUnit) uniform samplerBuffer vertices;  // two texels each: position and u; v
layout(binding = kFurrowIndicesUnit) uniform usamplerBuffer indices;

layout(location = 0) out vec3 position_ms;
layout(location = 1) out vec2 uv;

uniform mat4 clip_from_mesh;

void main() {
    int vertex = int(texelFetch(indices, gl_VertexID).x);
    vec4 first = texelFetch(vertices, 2 * vertex);
    position_ms = first.xyz;
    uv = vec2(first.w, texelFetch(vertices, 2 * vertex + 1).x);
    gl_Position = clip_from_mesh * vec4(position_ms, 1.0);
}
