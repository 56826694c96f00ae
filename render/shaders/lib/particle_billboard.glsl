// The corner of a billboard's quad: after lib/particle_sprite.glsl.

#include "lib/billboard.glsl"
layout(binding = kBillboardQuadsUnit) uniform samplerBuffer billboard_quads;

const int kAlignedView = 1;  // BillboardAlignment
const int kAlignedAxis = 2;

vec4 billboard_texel(Particle p, int texel) {
    return texelFetch(billboard_quads, p.record * int(kBillboardTexels) + texel);
}

Quad billboard_quad(Particle p) {
    vec4 first = billboard_texel(p, 0);
    vec3 right = first.xyz;
    vec3 up = billboard_texel(p, 1).xyz;
    vec3 camera_right = normalize(view.ray_right.xyz);
    if (int(first.w) == kAlignedView) {
        return Quad(length(right) * camera_right, length(up) * normalize(view.ray_up.xyz));
    }
    if (int(first.w) == kAlignedAxis) {
        right = length(right) * billboard_right(normalize(up), to_viewer(p.position), camera_right);
    }
    return Quad(right, up);
}

// Sets the particle's velocity, and an age that is larger than any frame time.
ParticleCorner billboard_corner(inout Particle p, Look look, int vertex) {
    float away = distance(p.position, view.camera_ws.xyz);
    ParticleCorner c;
    c.size = size_from(p, look.shape, int(look.glow.w), away);
    c.color = color_from(p, away);
    c.color.a *= p.opacity;
    c.quad = billboard_quad(p);
    c.book = flipbook_at(billboard_texel(p, 1).w, look.book, int(look.more.x));
    set_quad_corner(c, p, look, vertex);
    c.is_hidden = is_too_faint(look, c.color.a);
    p.velocity = billboard_texel(p, 2).xyz;
    p.age = 1e30;
    return c;
}
