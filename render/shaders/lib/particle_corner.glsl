// A vertex of a particle of any shape, and its varyings: after lib/particle.glsl, lib/particle_varyings.glsl and
// lib/view.glsl. Definitions: those of lib/lighting.glsl, lib/particle_shading.glsl and lib/particle_pass.glsl, and
//   CLIPPED  by the view's plane

uniform int first;         // of the particles to draw
uniform float resolution;  // of the image, as a fraction of the view's
uniform float framed;      // extent of the image, as a fraction of the viewport's

struct ParticleCorner {
    vec3 offset;       // from the particle's position [m]
    vec3 normal;       // for lighting
    vec3 coordinates;  // `corner` of lib/particle_varyings.glsl
    Quad quad;
    float size;  // diameter [m]
    vec4 color;  // and opacity
    Flipbook book;
    bool is_hidden;
};

#include "lib/height_fog.glsl"
#include "lib/particle_point.glsl"
#if defined(LIT) || defined(IN_WATER)
#include "lib/lighting.glsl"
#endif
#include "lib/particle_pass.glsl"
#include "lib/particle_shading.glsl"

bool is_sprite_hidden(Particle p, Look look, ParticleCorner c) {
    return c.size <= 0.0 || p.is_dead || is_too_faint(look, c.color.a) || is_out_of_water(p.position);
}

// `index`: of the particle among those of the view.
void write_corner(Particle p, Look look, ParticleCorner c, int index) {
    vec3 corner_ws = p.position + c.offset;
    gl_Position = view.clip_from_world * vec4(corner_ws, 1.0);
    gl_Position.xy *= framed;
#ifdef CLIPPED
    gl_ClipDistance[0] = dot(view.clip_plane, vec4(corner_ws, 1.0));
#endif
    corner = c.coordinates;
    distance_ahead = gl_Position.w;
    frames = c.book.frames;
    next_frame = vec4(c.book.next, look_texel(look.index, kLookMotion).xy);
    blend = vec4(cover_in_pass(look), look.streak.z, c.book.progress, look.book.w);
    write_shading(p, look, c, index);
    write_pass(p, look, corner_ws, distance_ahead);
}
