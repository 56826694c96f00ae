// What lib/wrinkle_surface.glsl needs of vertices: a hook of mesh.vert. Definitions:
//   WRINKLE_MAP, WRINKLE_VIEW  the strengths of wrinkles, or the strain; WRINKLE_FLAT: without interpolation
// Techniques: wrinkle.compression.interpolation, wrinkle.compression.tangent-frame

#if defined(WRINKLE_MAP) || defined(WRINKLE_VIEW)
#define WRINKLE_STREAM
VERTEX_INPUT(14, vec4, wrinkle);
#ifdef WRINKLE_FLAT
flat
#endif
layout(location = 8) out vec4 wrinkle_strength;
#endif

void wrinkle_vertex(inout vec3 tangent, vec3 normal) {
#ifdef WRINKLE_STREAM
    // Texture space of wrinkles: perpendicular to the normal, whatever skinning did (wrinkle.compression.tangent-frame).
    tangent -= normal * dot(normal, tangent);
    wrinkle_strength = wrinkle;
#endif
}
