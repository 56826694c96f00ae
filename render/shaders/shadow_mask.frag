// What the mask of a light says where the stencil test lets it.
#version 450

uniform float lit;

layout(location = 0) out float mask;

void main() {
    mask = lit;
}
