// Depth of pixels that particles cover, for depth of field: where their opacity is above the threshold of the look.
// Definitions: those of lib/sprite.glsl.
// Techniques: particle.depth-of-field
#version 450
#define VARYING in
#include "lib/particle_varyings.glsl"
#include "lib/sprite.glsl"

void main() {
    vec2 position = sprite_position(corner);
    vec4 s = sprite_at(position, frames, next_frame.xy, blend.z, blend.w, next_frame.zw);
    if (light.a * s.a * blend.x <= 1.0) {  // blend.x: 1 / the threshold
        discard;
    }
}
