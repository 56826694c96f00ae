// Bump mapping with the vectors to each light, and halfway to the viewer, found per vertex in tangent space
// (bump.vertex-light-space): a pixel reads one normal and multiplies it with both. Vectors to lamps keep their length:
// so they are linear in the plane of a triangle, and their interpolation is exact where all its frames are the same.
// That of halfway vectors is not; nor is either where frames differ, which small triangles hide. Definition
// SINGLE_LIGHTS: lib/single_lights.glsl.
// Techniques: bump.vertex-light-space
#version 450
#define UNMASKED  // shadow masks are in screen space
#include "lib/mesh_vertex.glsl"
#include "lib/lighting.glsl"
#include "lib/material_maps.glsl"
#include "lib/light_at.glsl"
#include "lib/single_lights.glsl"

layout(location = 0) out vec3 diffuse;   // of further lights; still to be multiplied by the base color map and the dress
layout(location = 1) out vec3 specular;
layout(location = 2) out vec4 uv;
layout(location = 3) out vec4 vertex_color;
layout(location = 4) flat out uvec2 material_and_flags;
#ifdef MAP_LAYERS
layout(location = 7) flat out vec4 map_layers;
#endif
layout(location = 8) out vec4 light_ts[SINGLE_LIGHTS];     // [m]; w: 1 if irradiance[] is at a distance of 1 m
layout(location = 12) out vec3 halfway_ts[SINGLE_LIGHTS];
layout(location = 16) out vec3 irradiance[SINGLE_LIGHTS];  // per vertex, or that of lamps with the inverse square law at 1 m
invariant gl_Position;  // the depth must equal that of depth_first.frag

// From the point to a light; of a directional one: unit. w: 1 if its light falls by the inverse square of the distance.
vec4 single_offset(LitPoint p, int k, vec3 to_light) {
    int local = k;
#ifdef DIRECTIONAL_LIGHTS
    local = k - int(view.grid_depth.z);
    if (local < 0) {
        return vec4(to_light, 0.0);
    }
#endif
    int index = existing_light(int(texelFetch(light_indices, int(p.list.x) + local).x));
    vec2 polynomial = texelFetch(lights, index * int(kLightTexels) + 2).xy;
    vec3 position = texelFetch(lights, index * int(kLightTexels)).xyz;
    return vec4(position - p.position_ws, polynomial == vec2(0.0) ? 1.0 : 0.0);
}

void main() {
    vec3 position_ws = vertex_ws();
    vec3 n = vertex_normal_ws();
    gl_Position = view.clip_from_world * vec4(position_ws, 1.0);
    uv = vec4(first_uv, second_uv);
    vertex_color = color;
    material_and_flags = instance.xy;
#ifdef MAP_LAYERS
    map_layers = map_layers_of(instance.x);
#endif
    vec3 t = vec3(dot(world_row0.xyz, tangent_ms.xyz), dot(world_row1.xyz, tangent_ms.xyz), dot(world_row2.xyz, tangent_ms.xyz));
    t *= inversesqrt(max(dot(t, t), 1e-30));
    LitPoint p = lit_point(MeshPoint(position_ws, n, color, instance.xy, instance.z));
    float side = dot(n, p.reflector.normal) < 0.0 ? -1.0 : 1.0;
    mat3 world_from_ts = side * mat3(t, cross(n, t) * (tangent_ms.w * vertex_side()), n);
    for (int k = 0; k < SINGLE_LIGHTS; ++k) {
        light_ts[k] = vec4(0.0, 0.0, 1.0, 0.0);
        halfway_ts[k] = vec3(0.0, 0.0, 1.0);
        irradiance[k] = vec3(0.0);
        if (k < p.single) {
            Incoming light = single_light(p, k);
            vec4 offset = single_offset(p, k, light.to_light);
            light_ts[k] = vec4(offset.xyz * world_from_ts, offset.w);
            halfway_ts[k] = (light.to_light + p.reflector.to_camera) * world_from_ts;
            irradiance[k] = light.irradiance * mix(1.0, dot(offset.xyz, offset.xyz), offset.w);
        }
    }
    Reflected light = light_from(p, p.single, p.single, kEveryLight);
    diffuse = light.diffuse;
    specular = light.specular;
}
