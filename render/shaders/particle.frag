// A particle: an image or a soft disc, fading where it meets a surface. Definition: IMAGES, some particle has one.
#version 450
#include "lib/radiance.glsl"
#include "lib/view.glsl"

layout(binding = 4) uniform sampler2D scene_depth;
#ifdef IMAGES
layout(binding = 0) uniform sampler2DArray images;
#endif

layout(location = 0) in vec3 corner;
layout(location = 1) in vec4 light;
layout(location = 2) flat in vec4 frames;
layout(location = 3) flat in vec4 blend;
layout(location = 4) flat in vec2 next_frame;
layout(location = 5) in float distance_ahead;

layout(location = 0) out vec4 radiance;

#ifdef IMAGES
// The frame at `offset`; it repeats along ribbons.
vec4 image_at(vec2 uv, vec2 offset) {
    float layer = max(blend.w, 0.0);
#ifdef RIBBONS
    vec2 repeated = vec2(uv.x - floor(uv.x), uv.y);
    return textureGrad(
        images, vec3(repeated * frames.xy + offset, layer), dFdx(uv) * frames.xy, dFdy(uv) * frames.xy);
#else
    return texture(images, vec3(uv * frames.xy + offset, layer));
#endif
}
#endif

// Color, and opacity in a.
vec4 sprite() {
    vec2 place = vec2(corner.x, corner.y / max(corner.z, 1e-6));
    float inside = max(1.0 - dot(place, place), 0.0);
    vec4 disc = vec4(1.0, 1.0, 1.0, inside * inside);
#ifdef IMAGES
    vec2 uv = vec2(0.5 + 0.5 * place.x, 0.5 - 0.5 * place.y);
    vec4 now = image_at(uv, frames.zw);
    vec4 next = image_at(uv, next_frame);
    return blend.w < 0.0 ? disc : mix(now, next, blend.z);
#else
    return disc;
#endif
}

void main() {
    vec4 s = sprite();
    float depth = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    float room = view_distance(max(depth, 1e-20)) - distance_ahead;
    float fade = clamp(room / max(blend.y, 1e-4), 0.0, 1.0);
    float weight = s.a * fade;
    radiance = vec4(storable(light.rgb * s.rgb * weight), light.a * weight * blend.x);
}
