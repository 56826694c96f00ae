// Writes a light's shadow mask where the stencil test passes.
#version 450

uniform float lit;

layout(location = 0) out float mask;

void main() {
    mask = lit;
}
