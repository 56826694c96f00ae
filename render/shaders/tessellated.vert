// Vertices of meshes that are tessellated: their attributes.
// Techniques: tex.displacement
#version 450
#include "lib/mesh_attributes.glsl"

#define ATTRIBUTE(at, type, name)          \
    layout(location = at) in type name; \
    layout(location = at) out type name##_out;
#define COPY(at, type, name) name##_out = name;

MESH_ATTRIBUTES(ATTRIBUTE)

void main() {
    MESH_ATTRIBUTES(COPY)
}
