// Varyings from particle.vert to its fragment shaders. Definitions: VARYING, `out` in the former and `in` in the
// latter; those of particle.vert and
//   WEIGHTED  into the sums of a weighted mean (render/particles/particle_weighted.h)
//   IN_WATER  visible from above, before the water is drawn over it
// Values that are the same at all corners are flat.

#if defined(LIT) || defined(RIBBONS)
#define LIGHT_INTERPOLATION smooth
#else
#define LIGHT_INTERPOLATION flat
#endif
#ifdef PARTICLE_SHADOWS  // which lie across a quad
#define SIDES_INTERPOLATION smooth
#else
#define SIDES_INTERPOLATION flat
#endif

layout(location = 0) VARYING vec3 corner;  // -1 .. 1; of ribbons, y is multiplied by z, so that it stays straight
layout(location = 1) LIGHT_INTERPOLATION VARYING vec4 light;  // radiance at the center, premultiplied by a: its opacity
layout(location = 2) flat VARYING vec4 frames;      // texture coordinates: scale xy, offset of the frame zw
layout(location = 3) flat VARYING vec4 blend;       // cover, softness [m], weight of the next frame, layer
layout(location = 4) flat VARYING vec4 next_frame;  // its offset; layer of the motion map, its full value
layout(location = 5) VARYING float distance_ahead;  // along the view axis [m]
#ifdef SIX_WAY
layout(location = 7) SIDES_INTERPOLATION VARYING vec4
    positive_side[3];  // of what comes from the right, above and behind: premultiplied radiance of a white particle; w:
                       // layer of their map, -1: none
layout(location = 10) SIDES_INTERPOLATION VARYING vec3
    negative_side[3];  // the same from the left, from below and from the camera
layout(location = 13) flat VARYING vec3 glow_color;  // radiance by itself, premultiplied
#endif
#ifdef WEIGHTED
layout(location = 14) VARYING float weight;  // of a layer at this distance
#endif
#ifdef IN_WATER
layout(location = 15) flat VARYING vec4 medium;  // extinction of the water that its center is in [1/m], index of refraction
#endif
