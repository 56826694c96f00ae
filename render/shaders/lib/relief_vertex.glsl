// What lib/relief_surface.glsl needs of vertices: a hook of mesh.vert. Definition:
//   RELIEF_MAP  the surface has relief
//   RELIEF_BOX  it is that of a box
//   OBJECT_NORMALS  its normal map is in mesh space

#ifdef RELIEF_MAP
#include "relief_gpu.h"
layout(location = 10) out vec4 relief_point;  // relief_position of fragments: from the camera [m]; w: scale of the instance
#ifdef RELIEF_CURVED
layout(binding = kCurvaturesUnit) uniform samplerBuffer curvatures;
layout(location = 11) out vec2 relief_curvature;  // of the mesh's quadric along tangent and bitangent [1/m]
#endif
#ifdef RELIEF_BOX
layout(location = 22) flat out mat3 box_from_world;  // steps, to u, v and depth of the map
#endif
#endif

#ifdef OBJECT_NORMALS
layout(location = 12) flat out mat3 world_from_normal;  // not unit
#endif

void relief_vertex(inout vec3 tangent, vec3 normal) {
#ifdef OBJECT_NORMALS
    world_from_normal = vertex_side() * transpose(mat3(
        cross(world_row1.xyz, world_row2.xyz), cross(world_row2.xyz, world_row0.xyz),
        cross(world_row0.xyz, world_row1.xyz)));
#endif
#ifdef RELIEF_MAP
    float volume = abs(dot(world_row0.xyz, cross(world_row1.xyz, world_row2.xyz)));
    relief_point = vec4(vertex_ws() - view.camera_ws.xyz, pow(volume, 1.0 / 3.0));
#ifdef RELIEF_CURVED
    relief_curvature = texelFetch(curvatures, gl_VertexID).xy / max(relief_point.w, 1e-20);
#endif
#ifdef RELIEF_BOX
    // The mesh has size 1 and a constant frame: the map's axes are those of the mesh.
    mat3 world_from_mesh = transpose(mat3(world_row0.xyz, world_row1.xyz, world_row2.xyz));
    vec3 down = tangent_ms.w * cross(tangent_ms.xyz, normal_ms);
    box_from_world = transpose(mat3(tangent_ms.xyz, down, -normal_ms)) * inverse(world_from_mesh);
#endif
#endif
}
