// One more layer of a shadow volume (shadow.density-view).
#version 450

layout(location = 0) out vec4 layers;

void main() {
    layers = vec4(1.0);
}
