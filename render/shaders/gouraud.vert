// Per-vertex lighting by all lights that reach the object (light.gouraud). Color and emission maps apply per pixel,
// that of roughness and metalness only by its mean, the others not at all.
#version 450
#define UNMASKED  // shadow masks are in screen space
#include "lib/mesh_vertex.glsl"
#include "lib/lighting.glsl"
#include "lib/material_maps.glsl"

const float kLastLevel = 16.0;  // or the last one

layout(location = 0) out vec3 diffuse;   // still to be multiplied by the base color map
layout(location = 1) out vec3 specular;
layout(location = 2) out vec4 uv;
layout(location = 3) out vec4 vertex_color;
layout(location = 4) flat out uvec2 material_and_flags;
#ifdef MAP_LAYERS
layout(location = 7) flat out vec4 map_layers;
#endif
invariant gl_Position;  // the depth must equal that of depth_first.frag

SurfaceSample vertex_surface() {
    vec4 base = material_texel(instance.x, 0);
    vec4 factors = material_texel(instance.x, 2);
    SurfaceSample s;
    s.normal_ws = vertex_normal_ws();
    s.albedo = base.rgb;
#ifdef VERTEX_COLOR
    s.albedo *= max(color.rgb, 0.0);
#endif
    s.emission = vec3(0.0);
    s.occlusion = 1.0;
    s.roughness = factors.y;
    s.metalness = factors.x;
    s.material = instance.x;
    s.model = instance.y >> 8;
#ifdef METAL_ROUGH_MAP
    float layer = map_layer(map_layers_of(instance.x), kMetalRoughSlot);
    vec2 mean = textureLod(material_maps[METAL_ROUGH_MAP], vec3(0.5, 0.5, layer), kLastLevel).gb;
    s.roughness *= mean.x;
    s.metalness *= mean.y;
#endif
    return s;
}

void main() {
    vec3 position_ws = vertex_ws();
    gl_Position = view.clip_from_world * vec4(position_ws, 1.0);
    vec2 pixel = (gl_Position.xy / gl_Position.w * 0.5 + 0.5) * view.size.xy;
    SurfaceSample s = vertex_surface();
#ifdef DOUBLE_SIDED
    s.normal_ws *= dot(s.normal_ws, view.camera_ws.xyz - position_ws) < 0.0 ? -1.0 : 1.0;
#endif
    // Here light_cells holds the lists of objects, not of cells.
    uvec2 list = uvec2(0u);
#ifdef LOCAL_LIGHTS
    list = texelFetch(light_cells, int(instance.z)).xy;
#endif
    split_unlit(s);
    set_no_smooth_normal(s);
    Reflected light = reflect_all(s, position_ws, pixel, list);
    diffuse = light.diffuse + s.emission;
    specular = light.specular;
    uv = vec4(first_uv, second_uv);
    vertex_color = color;
    material_and_flags = instance.xy;
#ifdef MAP_LAYERS
    map_layers = map_layers_of(instance.x);
#endif
}
