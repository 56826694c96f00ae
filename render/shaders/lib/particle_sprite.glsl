// The corner of a sprite: after lib/particle_corner.glsl and lib/particle_quad.glsl.

const float kSmallDisc = 3.0;  // radius up to which a disc is drawn as one triangle [px]

// Corners of a triangle around the unit disc; the other triangle of the quad is degenerate. A software OpenGL shades
// the pixel blocks along the diagonal of a quad twice.
vec2 triangle_corner(int vertex) {
    const float kApex = 1.5;
    const float kBase = 2.2360680;  // (apex + 1) / sqrt(apex^2 - 1)
    return vertex < 2 ? vec2(float(2 * vertex - 1) * kBase, -1.0) : vec2(0.0, kApex);
}

// Corner of the part of the quad that is drawn: without transparent margins of its image, or around a small disc.
vec2 drawn_corner(vec3 position, Look look, Flipbook book, Quad quad, int vertex) {
    vec2 corner = corner_of(vertex);
#ifdef IMAGES
    corner = trimmed_corner(corner, look.index, book, quad, pixel_extent(position) / resolution);
#endif
    bool is_small_disc = look.book.w < 0.0
                         && min(length(quad.right), length(quad.up)) * resolution < kSmallDisc * pixel_extent(position);
#ifdef LIT
    is_small_disc = is_small_disc && (look.glow.y <= 0.0 || look_texel(look.index, kLookFocus).y > 0.0);  // not lit at its corners
#endif
    return is_small_disc ? triangle_corner(vertex) : corner;
}

// Sets the corner of a quad whose size, color, axes and flipbook are set.
void set_quad_corner(inout ParticleCorner c, Particle p, Look look, int vertex) {
    vec2 at = drawn_corner(p.position, look, c.book, c.quad, vertex);
    c.coordinates = vec3(at, 1.0);
    c.offset = at.x * c.quad.right + at.y * c.quad.up;
    c.normal = rounded_normal(p.position, c.offset);
}

ParticleCorner sprite_corner(Particle p, Look look, int vertex) {
    int facing = int(look.glow.w);
    float away = distance(p.position, view.camera_ws.xyz);
    ParticleCorner c;
    c.size = size_from(p, look.shape, facing, away);
    c.color = color_from(p, away);
    c.quad = quad_of(p, look.shape, look.streak, look.more.w, facing, c.size);
    c.book = flipbook_of(p, look.book, int(look.more.x));
    set_quad_corner(c, p, look, vertex);
    c.is_hidden = is_sprite_hidden(p, look, c);
    return c;
}
