// Passes triangles through. A software OpenGL rounds positions differently after a geometry shader, so that triangles
// which pass through one later must do so in the depth prepass, too.
#version 450
#include "lib/facet.glsl"

void main() {
    for (int i = 0; i < 3; ++i) {
        put_corner(i);
        EmitVertex();
    }
    EndPrimitive();
}
