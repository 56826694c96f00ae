// One triangle that covers the target, at the far plane: with the depth test GL_EQUAL it draws where there is no
// surface, with GL_LESS where there is one. Definition:
//   SHADING_LOBE  draws at the depth of this lobe's pixels (shading_lobes.frag)
#version 450

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
#ifdef SHADING_LOBE
    float depth = float(SHADING_LOBE) / 16.0;
#else
    float depth = 0.0;
#endif
    gl_Position = vec4(corner, depth, 1.0);
}
