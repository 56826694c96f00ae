// Relief as geometry: a hook of lib/mesh_vertex.glsl. Definition:
//   RELIEF_DISPLACED  in an evaluation stage: vertices lie on the relief, below the mesh
// Techniques: tex.displacement

#include "lib/material_maps.glsl"
#include "relief_gpu.h"

#if defined(RELIEF_DISPLACED) && defined(TESSELLATED)
layout(location = 16) patch in vec3 relief_texels;

// The map is filtered over the distance between vertices. Of an edge only what its triangles share matters; toward the
// corners of the triangle, whose other triangles have other distances, it becomes 0.
float displacement_lod() {
    vec3 t = gl_TessCoord;
    precise vec3 weight = vec3(t.y * t.z, t.z * t.x, t.x * t.y);
    precise float sum = max(weight.x + weight.y + weight.z, 1e-9);
    vec3 levels = vec3(gl_TessLevelOuter[0], gl_TessLevelOuter[1], gl_TessLevelOuter[2]);
    vec3 apart = relief_texels / max(levels, 1.0);
    precise float texels = (weight.x * relief_texels.x + weight.y * relief_texels.y + weight.z * relief_texels.z) / sum;
    precise float vertex_texels = (weight.x * apart.x + weight.y * apart.y + weight.z * apart.z) / sum;
    float to_corner = 1.0 - max(t.x, max(t.y, t.z));
    return log2(max(min(vertex_texels, texels * to_corner), 1.0));
}
#endif

void relief_position(inout vec3 position) {
#if defined(RELIEF_DISPLACED) && defined(TESSELLATED)
    vec2 at = map_coordinates(instance.x, kReliefSlot, vec4(first_uv, second_uv), 1.0);
    float layer = map_layer(map_layers_of(instance.x), kReliefSlot);
    float depth = textureLod(material_maps[RELIEF_MAP], vec3(at, layer), displacement_lod()).w;
    float unit = inversesqrt(max(dot(normal_ms, normal_ms), 1e-30));
    position -= normal_ms * (unit * depth * block_texel(instance.x, kReliefBlock, 0).x);
#endif
}
