// The image of a particle: a frame of a flipbook on its way to the next, or a soft disc. Definitions:
//   IMAGES   some particle has an image
//   RIBBONS  some are segments of ribbons, along which it repeats

#ifdef IMAGES
layout(binding = 0) uniform sampler2DArray images;

// The frame at `offset`; `frames` as in lib/particle.glsl.
vec4 image_at(vec2 uv, vec4 frames, vec2 offset, float layer) {
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
//   place     in the quad, -1 .. 1
//   layer     of its image; < 0: none
vec4 sprite_at(vec2 place, vec4 frames, vec2 next_frame, float progress, float layer) {
    float inside = max(1.0 - dot(place, place), 0.0);
    vec4 disc = vec4(1.0, 1.0, 1.0, inside * inside);
#ifdef IMAGES
    vec2 uv = vec2(0.5 + 0.5 * place.x, 0.5 - 0.5 * place.y);
    vec4 now = image_at(uv, frames, frames.zw, max(layer, 0.0));
    vec4 next = image_at(uv, frames, next_frame, max(layer, 0.0));
    return layer < 0.0 ? disc : mix(now, next, progress);
#else
    return disc;
#endif
}
