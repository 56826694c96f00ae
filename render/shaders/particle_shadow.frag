// Adds a particle's slab to the Fourier series of each ray (lib/fourier_opacity.glsl). Definitions: IMAGES, FLIPBOOKS,
// MOTION.
#version 450
#include "lib/fourier_opacity.glsl"
#include "lib/sprite.glsl"

layout(location = 0) in vec2 corner;
layout(location = 1) flat in vec4 slab;
layout(location = 2) flat in vec4 frames;
layout(location = 3) flat in vec3 next_frame;
layout(location = 4) flat in vec3 tint;
layout(location = 5) flat in vec2 motion;

layout(location = 0) out vec4 low;
layout(location = 1) out vec4 high;
layout(location = 2) out vec4 tinted;  // optical depth for red, green and blue

void main() {
    vec4 s = sprite_at(corner, frames, next_frame.xy, slab.w, next_frame.z, motion);
    OpacitySeries series = slab_series(slab.x * s.a, slab.y, slab.z);
    low = series.low;
    high = series.high;
    tinted = vec4(0.5 * series.low.x * tint, 0.0);
}
