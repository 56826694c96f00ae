// One triangle over the whole target, at the far plane: with the depth test GL_EQUAL it covers what no surface
// covers, with GL_LESS what one does.
#version 450

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(corner, 0.0, 1.0);
}
