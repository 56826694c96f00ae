// A particle as a quad: a sprite, a billboard or a segment of a ribbon, in any sequence within one draw call.
// Definitions: those of lib/particle_corner.glsl, and
//   RIBBONS     some are segments of ribbons
//   BILLBOARDS  some are quads of billboards
// Techniques: engine.particle-cpu, engine.particle-params, particle.gpu-draw
#version 450
#define UNMASKED  // shadow masks hold the shadows of the surfaces behind
#define VARYING out
#include "lib/particle.glsl"
#include "lib/particle_varyings.glsl"
#include "lib/view.glsl"
#include "lib/particle_corner.glsl"
#include "lib/particle_quad.glsl"

#include "lib/particle_sprite.glsl"
#ifdef RIBBONS
#include "lib/particle_ribbon.glsl"
#endif
#ifdef BILLBOARDS
#include "lib/particle_billboard.glsl"
#endif

ParticleCorner corner_of_shape(inout Particle p, Look look, int vertex) {
#ifdef RIBBONS
    if (uint(look.glow.w) == kFacingRibbon) {
        return ribbon_corner(p, look, vertex);
    }
#endif
#ifdef BILLBOARDS
    if (uint(look.glow.w) == kFacingBillboard) {
        return billboard_corner(p, look, vertex);
    }
#endif
    return sprite_corner(p, look, vertex);
}

void main() {
    int index = first + (gl_VertexID >> 2);
    Particle p = read_particle(index);
    Look look = read_look(p.look);
    ParticleCorner c = corner_of_shape(p, look, gl_VertexID & 3);
    write_corner(p, look, c, index);
    if (c.is_hidden) {
        gl_Position = vec4(0.0, 0.0, 0.5, 1.0);  // degenerate rather than outside the image, where it would be clipped
    }
}
