// The offset of post.scene-ripple, per pixel.
#version 450
#include "lib/ripple.glsl"
#include "lib/view.glsl"

uniform vec2 center;
uniform float radius;
uniform float amplitude;
uniform float aspect;

layout(location = 0) out vec4 shift;  // [px]; alpha: maximum depth to read

void main() {
    vec2 uv = gl_FragCoord.xy * view.size.zw;
    shift = vec4(view.size.xy * screen_ripple(uv, center, radius, amplitude, aspect), 0.0, 1.0);
}
