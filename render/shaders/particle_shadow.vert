// A particle as a light sees it: a slab that faces it.
#version 450
#include "lib/particle.glsl"

layout(binding = kParticleShadowUnit) uniform samplerBuffer particle_shadow;  // ParticleShadowRecord
uniform int first;                                                            // of the particles to draw
uniform vec3 light_right;                                                     // unit, along the map's columns and rows
uniform vec3 light_up;

layout(location = 0) out vec2 corner;
layout(location = 1) flat out vec4 slab;  // opacity, depth, thickness (fractions of the range), progress of the flipbook
layout(location = 2) flat out vec4 frames;
layout(location = 3) flat out vec3 next_frame;  // its offset; layer of the image
layout(location = 4) flat out vec3 tint;
layout(location = 5) flat out vec2 motion;  // layer of the motion map, its full value

void main() {
    Particle p = read_particle(first + (gl_VertexID >> 2));
    vec4 shape = look_texel(p.look, 0u);
    vec4 book = look_texel(p.look, 3u);
    float size = size_of(p, shape);
    float angle = angle_of(p, shape, look_texel(p.look, 1u));
    corner = corner_of(gl_VertexID & 3);
    vec2 turned = mat2(cos(angle), sin(angle), -sin(angle), cos(angle)) * corner;
    vec4 position = vec4(p.position + 0.5 * size * (turned.x * light_right + turned.y * light_up), 1.0);
    vec2 st = vec2(dot(texelFetch(particle_shadow, 0), position), dot(texelFetch(particle_shadow, 1), position));
    float q = dot(texelFetch(particle_shadow, 3), position);
    gl_Position = vec4(2.0 * st - q, 0.0, q);

    vec4 opacity = look_texel(p.look, kLookShadow);
    Flipbook flipbook = flipbook_of(p, book, int(look_texel(p.look, kLookMore).x));
    slab = vec4(color_of(p).a * opacity.w, dot(texelFetch(particle_shadow, 2), vec4(p.position, 1.0)),
                size * texelFetch(particle_shadow, 4).y,
                flipbook.progress);
    frames = flipbook.frames;
    next_frame = vec3(flipbook.next, book.w);
    tint = opacity.rgb;
    motion = look_texel(p.look, kLookMotion).xy;
    if (size <= 0.0 || slab.x <= 0.0 || p.is_dead) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    }
}
