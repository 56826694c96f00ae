// The corner of a segment of a ribbon: after lib/particle_corner.glsl and lib/particle_quad.glsl.

#include "lib/ribbon.glsl"
layout(binding = kRibbonPointsUnit) uniform samplerBuffer ribbon_points;

// A segment from `begin` to `end`, with the points of its neighbors; a join if `begin` and `end` coincide.
struct RibbonSegment {
    vec3 before;
    vec3 begin;
    vec3 end;
    vec3 after;
    vec4 point;  // at the corner: position, texture coordinate along the ribbon
    vec4 rest;   // at the corner: span, position on the look's curves
};

vec4 ribbon_texel(int point, int texel) {
    return texelFetch(ribbon_points, point * int(kRibbonTexels) + texel);
}

RibbonSegment ribbon_segment(int before, int end) {
    vec4 points[4];
    for (int i = 0; i < 4; ++i) {
        points[i] = ribbon_texel(before + i, 0);
    }
    return RibbonSegment(points[0].xyz, points[1].xyz, points[2].xyz, points[3].xyz, points[1 + end],
                         ribbon_texel(before + 1 + end, 1));
}

// From the center line of the ribbon to the corner; -1 .. 1 across it in w.
vec4 ribbon_side(RibbonSegment s, int vertex, float half_width, bool has_image) {
    vec3 to_camera = normalize(view.camera_ws.xyz - s.point.xyz);
    vec3 right = normalize(view.ray_right.xyz);
    float side = float(vertex >> 1) * 2.0 - 1.0;
    bool is_cap = s.before == s.after;
    if (s.begin == s.end) {
        return is_cap && has_image ? vec4(0.0)
                                   : half_width * ribbon_join(s.before, s.begin, s.after, vertex, to_camera, right);
    }
    bool at_begin = (vertex & 1) == 0;
    vec3 before = at_begin ? s.before : s.begin;
    vec3 after = at_begin ? s.end : s.after;
    return vec4(side * ribbon_edge(before, s.point.xyz, after, to_camera, right, half_width), side * half_width);
}

// Moves the particle to the end of the segment at which the corner is.
ParticleCorner ribbon_corner(inout Particle p, Look look, int vertex) {
    RibbonSegment segment = ribbon_segment(p.record, vertex & 1);
    p.position = segment.point.xyz;
    p.life_fraction = segment.rest.w;
    float away = distance(p.position, view.camera_ws.xyz);
    ParticleCorner c;
    c.size = size_from(p, look.shape, int(look.glow.w), away);
    c.color = color_from(p, away);
    c.quad = Quad(vec3(0.0), vec3(0.0));
    c.book = flipbook_of(p, look.book, int(look.more.x));
    c.is_hidden = kHidesRibbons;
    bool is_disc = look.book.w < 0.0;
    vec3 span = segment.rest.xyz;
    float side = corner_of(vertex).y;
    float half_width = 1.0;
    if (span == vec3(0.0)) {
        float thinnest = pixel_extent(p.position);  // below it fainter instead of narrower, or it would break up into dots
        c.color.a *= min(0.5 * c.size / thinnest, 1.0);
        half_width = max(0.5 * c.size, thinnest);
        vec4 across = ribbon_side(segment, vertex, half_width, !is_disc);
        c.offset = across.xyz;
        side = across.w;
    } else {
        c.offset = side * 0.5 * size_factor(look.index, p.life_fraction * float(kLookSamples - 1u)) * span;
        p.position += 0.5 * span;
    }
    c.normal = rounded_normal(p.position, c.offset);
    // A disc's profile is the same all along.
    c.coordinates = vec3(is_disc ? 0.0 : 2.0 * segment.point.w - 1.0, side, half_width);
    return c;
}
