// Shared by vertex shaders that light vertices, while pixels read a part of the light from a texture. The file that
// includes it defines main(), or map_coordinates() and includes lib/map_lights.glsl.
#define UNMASKED  // shadow masks are in screen space
#include "lib/mesh_vertex.glsl"
#include "lib/lighting.glsl"
#include "lib/material_maps.glsl"
#include "lib/light_at.glsl"
#include "lib/single_lights.glsl"
#include "lib/highlight_map.glsl"
#include "highlight_gpu.h"

layout(binding = kHighlightLayersUnit) uniform usamplerBuffer highlight_layers;  // by material

layout(location = 0) out vec3 diffuse;   // still to be multiplied by the base color map and the dress
layout(location = 1) out vec3 specular;
layout(location = 2) out vec4 uv;
layout(location = 3) out vec4 vertex_color;
layout(location = 4) flat out uvec2 material_and_flags;
layout(location = 6) flat out float highlight_layer;
#ifdef MAP_LAYERS
layout(location = 7) flat out vec4 map_layers;
#endif
layout(location = 8) out vec3 map_at[SINGLE_LIGHTS];       // in the unit disc; z: N.L
layout(location = 16) out vec3 map_factor[SINGLE_LIGHTS];  // of the value read there
#ifdef BLINN_DIFFUSE
layout(location = 12) out vec2 diffuse_at[SINGLE_LIGHTS];
layout(location = 20) out vec3 diffuse_factor[SINGLE_LIGHTS];
#endif
invariant gl_Position;  // the depth must equal that of depth_first.frag

// Writes all outputs except light; returns the point to be lit.
LitPoint put_vertex() {
    vec3 position_ws = vertex_ws();
    gl_Position = view.clip_from_world * vec4(position_ws, 1.0);
    uv = vec4(first_uv, second_uv);
    vertex_color = color;
    material_and_flags = instance.xy;
    highlight_layer = float(texelFetch(highlight_layers, int(instance.x)).x);
#ifdef MAP_LAYERS
    map_layers = map_layers_of(instance.x);
#endif
    return lit_point(MeshPoint(position_ws, vertex_normal_ws(), color, instance.xy, instance.z));
}
