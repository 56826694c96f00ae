// Velocity of pixels that particles cover, as gbuffer.frag writes it for surfaces: where opacity times cover is above
// the threshold of the look. Definitions: those of lib/sprite.glsl, and SOFT as in particle.frag.
// Techniques: particle.velocity
#version 450
#define VARYING in
#include "lib/particle_varyings.glsl"
#include "lib/sprite.glsl"
#include "lib/velocity.glsl"
#include "lib/view.glsl"

#ifdef SOFT
layout(binding = kParticleDepthUnit) uniform sampler2D scene_depth;
#endif

layout(location = 6) in vec3 previous_clip;

layout(location = 0) out vec2 velocity;

void main() {
    vec2 position = sprite_position(corner);
    vec4 s = sprite_at(position, frames, next_frame.xy, blend.z, blend.w, next_frame.zw);
    float fade = 1.0;
#ifdef SOFT
    float depth = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    float gap = view_distance(max(depth, 1e-20)) - distance_ahead;
    fade = clamp(gap / max(blend.y, 1e-4), 0.0, 1.0);
#endif
    vec2 now_ndc = gl_FragCoord.xy * view.size.zw * 2.0 - 1.0 - vec2(view.ray_right.w, view.ray_up.w);
    velocity = velocity_from(now_ndc, previous_clip, view.size.xy);
    if (light.a * s.a * fade * blend.x <= 1.0) {  // blend.x: cover / the threshold
        discard;
    }
}
