// A particle: an image or a soft disc. Definitions: those of lib/sprite.glsl, and
//   SOFT  some fade where they meet a surface
//   SIX_WAY  some have images of the light from six sides
//   WEIGHTED  into the sums of a weighted mean (render/particle_weighted.h)
#version 450
#if defined(SIX_WAY) && !defined(IMAGES)
#define IMAGES
#endif
#include "lib/radiance.glsl"
#include "lib/sprite.glsl"
#include "lib/view.glsl"

#ifdef SOFT
layout(binding = 4) uniform sampler2D scene_depth;
#endif

layout(location = 0) in vec3 corner;
layout(location = 1) in vec4 light;
layout(location = 2) flat in vec4 frames;
layout(location = 3) flat in vec4 blend;
layout(location = 4) flat in vec4 next_frame;
layout(location = 5) in float distance_ahead;
#ifdef SIX_WAY
layout(location = 7) in vec4 positive_side[3];
layout(location = 10) in vec3 negative_side[3];
layout(location = 13) in vec3 glow_color;

layout(binding = 27) uniform sampler2DArray negative_lights;
#endif

layout(location = 0) out vec4 radiance;
#ifdef WEIGHTED
layout(location = 1) out float opacity;

uniform vec2 weight_range;  // nearest distance ahead [m], 1 / (farthest - nearest)

const float kWeightFall = 8.0;  // optical depth of the cloud that the weights suit

float weight_at(float ahead) {
    return exp(-kWeightFall * clamp((ahead - weight_range.x) * weight_range.y, 0.0, 1.0));
}
#endif

void main() {
    vec2 place = sprite_place(corner);
    vec4 s = sprite_at(place, frames, next_frame.xy, blend.z, blend.w, next_frame.zw);
    vec3 shown = light.rgb * s.rgb;
#ifdef SIX_WAY
    if (positive_side[0].w >= 0.0) {
        vec4 n = book_at(
            negative_lights, place, frames, next_frame.xy, blend.z, positive_side[0].w, next_frame.zw);
        shown = glow_color * n.a;
        for (int i = 0; i < 3; ++i) {
            shown += s[i] * positive_side[i].rgb + n[i] * negative_side[i];
        }
    }
#endif
    float fade = 1.0;
#ifdef SOFT
    float depth = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    float room = view_distance(max(depth, 1e-20)) - distance_ahead;
    fade = clamp(room / max(blend.y, 1e-4), 0.0, 1.0);
#endif
    float weight = s.a * fade;
    radiance = vec4(storable(shown * weight), light.a * weight * blend.x);
#ifdef WEIGHTED
    opacity = radiance.a;
    radiance *= weight_at(distance_ahead);
#endif
}
