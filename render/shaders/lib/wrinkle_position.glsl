// Folds of skin that move its vertices: a hook of lib/mesh_vertex.glsl. Definition:
//   WRINKLE_DISPLACED  they do
// Techniques: wrinkle.displacement

#ifdef WRINKLE_DISPLACED
VERTEX_INPUT(15, float, fold_height);  // along the normal [m]
#endif

void wrinkle_position(inout vec3 position) {
#ifdef WRINKLE_DISPLACED
    position += fold_height * normal_ms;
#endif
}
