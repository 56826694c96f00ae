// The image of a particle: a frame of a flipbook mixed with the next, or a soft disc. Definitions:
//   IMAGES   some particle has an image
//   FLIPBOOKS  some of them have several frames
//   RIBBONS  some are segments of ribbons, along which it repeats
//   POINTS   all are discs, drawn as points
//   MOTION   some flipbook has a motion map: both frames are fetched where what is visible between them has been or
//            will be, so that shapes move instead of cross-fading (particle.motion-vectors)
// Techniques: particle.motion-vectors

#include "particle_gpu.h"

#ifdef IMAGES
layout(binding = kSpriteImagesUnit) uniform sampler2DArray images;

// The frame at `offset`; `frames` as in lib/particle.glsl.
vec4 image_at(sampler2DArray book, vec2 uv, vec4 frames, vec2 offset, float layer) {
#ifdef RIBBONS
    vec2 repeated = vec2(uv.x - floor(uv.x), uv.y);
    return textureGrad(
        book, vec3(repeated * frames.xy + offset, layer), dFdx(uv) * frames.xy, dFdy(uv) * frames.xy);
#else
    return texture(book, vec3(uv * frames.xy + offset, layer));
#endif
}

#ifdef MOTION
layout(binding = kSpriteMotionsUnit) uniform sampler2DArray motion_maps;

// Motion at `uv` from the frame at `offset` to the next one, as a fraction of the frame; `motion`: layer of the map,
// what its full value means.
vec2 motion_at(vec2 uv, vec4 frames, vec2 offset, vec2 motion) {
    vec2 encoded = textureLod(motion_maps, vec3(uv * frames.xy + offset, motion.x), 0.0).rg;
    return motion.y * (encoded * (255.0 / 127.0) - 128.0 / 127.0);
}

// Clamped to the centers of the frame's outermost texels.
vec2 within_frame(vec2 uv, vec4 frames) {
    vec2 half_texel = 0.5 / (vec2(textureSize(images, 0).xy) * frames.xy);
    return clamp(uv, half_texel, 1.0 - half_texel);
}
#endif

// The frame at `position` in the quad, mixed with the next; arguments as of sprite_at, layer >= 0.
vec4 book_at(
    sampler2DArray book, vec2 position, vec4 frames, vec2 next_frame, float progress, float layer, vec2 motion) {
    vec2 uv = vec2(0.5 + 0.5 * position.x, 0.5 - 0.5 * position.y);
    vec2 from = uv;
    vec2 to = uv;
#if defined(MOTION) && defined(FLIPBOOKS)
    if (motion.x >= 0.0) {
        from = within_frame(uv - progress * motion_at(uv, frames, frames.zw, motion), frames);
        to = within_frame(uv + (1.0 - progress) * motion_at(uv, frames, next_frame, motion), frames);
    }
#endif
    vec4 shown = image_at(book, from, frames, frames.zw, layer);
#ifdef FLIPBOOKS
    shown = mix(shown, image_at(book, to, frames, next_frame, layer), progress);
#endif
    return shown;
}
#endif

// Position in the quad, -1 .. 1, of a fragment; `corner` as in particle.vert.
vec2 sprite_position(vec3 corner) {
#ifdef POINTS
    return vec2(2.0, -2.0) * (gl_PointCoord - 0.5);
#elif !defined(RIBBONS)
    return corner.xy;
#else
    return vec2(corner.x, corner.y / max(corner.z, 1e-6));
#endif
}

// Color, and opacity in a.
//   position  in the quad, -1 .. 1
//   layer     of its image; < 0: none
//   motion    layer of its motion map, < 0: none; what the map's full value means, as a fraction of a frame
vec4 sprite_at(vec2 position, vec4 frames, vec2 next_frame, float progress, float layer, vec2 motion) {
    float inside = max(1.0 - dot(position, position), 0.0);
    vec4 disc = vec4(1.0, 1.0, 1.0, inside * inside);
#ifdef IMAGES
    vec4 shown = book_at(images, position, frames, next_frame, progress, max(layer, 0.0), motion);
    return layer < 0.0 ? disc : shown;
#else
    return disc;
#endif
}
