// Per-vertex lighting by all lights that reach the object (light.gouraud).
// Techniques: fakephong.gouraud, light.gouraud
#version 450
#define UNMASKED  // shadow masks are in screen space
#include "lib/mesh_vertex.glsl"
#include "lib/lighting.glsl"
#include "lib/material_maps.glsl"
#include "lib/light_at.glsl"

layout(location = 0) out vec3 diffuse;   // still to be multiplied by the base color map and the dress
layout(location = 1) out vec3 specular;
layout(location = 2) out vec4 uv;
layout(location = 3) out vec4 vertex_color;
layout(location = 4) flat out uvec2 material_and_flags;
#ifdef MAP_LAYERS
layout(location = 7) flat out vec4 map_layers;
#endif
invariant gl_Position;  // the depth must equal that of depth_first.frag

void main() {
    vec3 position_ws = vertex_ws();
    gl_Position = view.clip_from_world * vec4(position_ws, 1.0);
    Reflected light = light_at(MeshPoint(position_ws, vertex_normal_ws(), color, instance.xy, instance.z));
    diffuse = light.diffuse;
    specular = light.specular;
    uv = vec4(first_uv, second_uv);
    vertex_color = color;
    material_and_flags = instance.xy;
#ifdef MAP_LAYERS
    map_layers = map_layers_of(instance.x);
#endif
}
