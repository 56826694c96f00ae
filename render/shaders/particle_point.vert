// A particle as a point: a disc that faces the camera. Definitions: those of lib/particle_corner.glsl.
#version 450
#define UNMASKED  // shadow masks are of the surfaces behind
#define VARYING out
#include "lib/particle.glsl"
#include "lib/particle_varyings.glsl"
#include "lib/view.glsl"
#include "lib/particle_corner.glsl"

void main() {
    int index = first + gl_VertexID;
    Particle p = read_particle(index);
    Look look = read_look(p.look);
    int facing = int(look.glow.w);
    float away = distance(p.position, view.camera_ws.xyz);
    ParticleCorner c;
    c.size = size_from(p, look.shape, facing, away);
    c.color = color_from(p, away);
    float diameter = resolution * point_diameter(p.position, c.size, facing, away);
    c.color.a *= point_opacity(diameter);
    c.quad = Quad(vec3(0.0), vec3(0.0));
    c.offset = vec3(0.0);
    c.normal = to_viewer(p.position);
    c.coordinates = vec3(0.0, 0.0, 1.0);
    c.book = flipbook_of(p, look.book, int(look.more.x));
    c.is_hidden = is_sprite_hidden(p, look, c);
    gl_PointSize = max(diameter, kMinPoint);
    write_corner(p, look, c, index);
    if (c.is_hidden) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    }
}
