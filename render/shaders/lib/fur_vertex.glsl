// What lib/fur_surface.glsl needs of vertices: a hook of mesh.vert. Definition:
//   FUR_SHELL  a shell of a coat of fur
// Techniques: shade.fur

#ifdef FUR_SHELL
layout(location = 20) out vec4 fur_at;      // root in cells; z: height; w: cosine of the normal to the viewer
layout(location = 21) out vec3 fur_strand;  // toward the tip, world space, not unit
#endif

void fur_vertex(inout vec3 tangent, vec3 normal) {
#ifdef FUR_SHELL
    vec4 strands = fur_texel(instance.y, 1);
    vec2 root = strands.w > 0.5 ? second_uv : first_uv;
    fur_at = vec4(root * strands.yz, fur_height(), dot(normal, normalize(view.camera_ws.xyz - vertex_ws())));
    vec3 n = normal_ms * inversesqrt(max(dot(normal_ms, normal_ms), 1e-30));
    vec3 along = n + 2.0 * fur_at.z * fur_lean();
    fur_strand = vec3(dot(world_row0.xyz, along), dot(world_row1.xyz, along), dot(world_row2.xyz, along));
#endif
}
