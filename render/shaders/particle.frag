// A particle: an image or a soft disc. Definitions: those of lib/sprite.glsl, and
//   SOFT  some fade where they meet a surface
//   SIX_WAY  some have images of the light from six sides
//   WEIGHTED  into the sums of a weighted mean (render/particles/particle_weighted.h)
//   IN_WATER  visible from above, before the water is drawn over it
//   VEILED  only pixels behind the nearest blended surface of the view, or only the others
// Techniques: particle.light-source-render, particle.weighted-blended
#version 450
#if defined(SIX_WAY) && !defined(IMAGES)
#define IMAGES
#endif
#define VARYING in
#include "lib/particle_varyings.glsl"
#include "lib/radiance.glsl"
#include "lib/sprite.glsl"
#include "lib/view.glsl"

#if defined(SOFT) || defined(IN_WATER)
layout(binding = kParticleDepthUnit) uniform sampler2D scene_depth;
#endif

#ifdef SIX_WAY
layout(binding = kNegativeLightsUnit) uniform sampler2DArray negative_lights;
#endif

#ifdef VEILED
layout(binding = kParticleVeilUnit) uniform sampler2D veil;  // depth of the nearest blended surface, 0: none
uniform int behind;                                          // 1: pixels behind it; 0: the others
uniform float resolution;                                    // of the image, as a fraction of the view's
#endif

layout(location = 0) out vec4 radiance;
#ifdef WEIGHTED
layout(location = 1) out float opacity;
#endif

#ifdef IN_WATER
const float kMaxOpticalDepth = 4.0;  // that is undone: 55 times the radiance still fits a half float

// The water pass will apply the absorption of the whole path down to the ground: the factor that undoes the part of it
// behind the particle. `gap`: from the particle to the ground along the view axis [m]. The path in the water is that of
// light refracted by a flat surface.
vec3 undo_absorption(float gap) {
    vec3 ray = view_ray(gl_FragCoord.xy);
    float sine = length(ray.xz) / length(ray) / medium.w;
    float path = max(gap, 0.0) * max(-ray.y, 0.0) * inversesqrt(1.0 - sine * sine);
    return exp(min(medium.rgb * path, vec3(kMaxOpticalDepth)));
}
#endif

void main() {
#ifdef VEILED
    ivec2 at = min(ivec2(gl_FragCoord.xy / resolution), textureSize(veil, 0) - 1);
    bool is_behind = gl_FragCoord.z < texelFetch(veil, at, 0).r;
    if (is_behind != (behind != 0)) {
        discard;
    }
#endif
    vec2 position = sprite_position(corner);
    vec4 s = sprite_at(position, frames, next_frame.xy, blend.z, blend.w, next_frame.zw);
    vec3 shown = light.rgb * s.rgb;
#ifdef SIX_WAY
    if (positive_side[0].w >= 0.0) {
        vec4 n = book_at(
            negative_lights, position, frames, next_frame.xy, blend.z, positive_side[0].w, next_frame.zw);
        shown = glow_color * n.a;
        for (int i = 0; i < 3; ++i) {
            shown += s[i] * positive_side[i].rgb + n[i] * negative_side[i];
        }
    }
#endif
    float fade = 1.0;
#if defined(SOFT) || defined(IN_WATER)
    float depth = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    float gap = view_distance(max(depth, 1e-20)) - distance_ahead;
#endif
#ifdef IN_WATER
    shown *= undo_absorption(gap);
#endif
#ifdef SOFT
    fade = clamp(gap / max(blend.y, 1e-4), 0.0, 1.0);
#endif
    float kept = s.a * fade;
    radiance = vec4(storable(shown * kept), light.a * kept * blend.x);
#ifdef WEIGHTED
    opacity = radiance.a;
    radiance *= weight;
#endif
}
