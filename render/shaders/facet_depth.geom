// Triangles as they are. A software OpenGL rounds places otherwise after a geometry shader, so that triangles which go
// through one later must do so for their depth, too.
#version 450
#include "lib/facet.glsl"

void main() {
    for (int i = 0; i < 3; ++i) {
        put_corner(i);
        EmitVertex();
    }
    EndPrimitive();
}
