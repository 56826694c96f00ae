// The shift, interpolated between the points of a grid.
#version 450
#include "lib/view.glsl"

layout(location = 0) in vec2 shift_uv;
layout(location = 0) out vec4 shift;  // [px]; alpha: maximum depth to read

void main() {
    shift = vec4(view.size.xy * shift_uv, 0.0, 1.0);
}
