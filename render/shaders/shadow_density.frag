// Counts layers of shadow volumes (shadow.density-view).
// Techniques: shadow.density-view
#version 450

layout(location = 0) out vec4 layers;

void main() {
    layers = vec4(1.0);
}
