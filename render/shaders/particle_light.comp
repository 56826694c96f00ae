// The light that particles whose look is lit at the center scatter, evaluated once per particle. Definitions: those of
// lib/lighting.glsl.
// Techniques: particle.lit-in-middle
#version 450
#define UNMASKED  // shadow masks are of the surfaces behind
#define MEAN_OF_CORNERS
#include "lib/particle.glsl"  // not first within lib/lighting.glsl, where an #ifdef would hide it
#include "lib/lighting.glsl"
#include "lib/particle_quad.glsl"
#include "lib/particle_scattering.glsl"
#include "lib/view.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = kCenterLightBinding) writeonly buffer Light {
    vec4 center_light[];  // radiance of a white particle
};

uniform int count;

mat4x3 corner_normals(vec3 position_ws, Quad quad) {
    mat4x3 normals;
    for (int i = 0; i < 4; ++i) {
        vec2 corner = corner_of(i);
        normals[i] = rounded_normal(position_ws, corner.x * quad.right + corner.y * quad.up);
    }
    return normals;
}

void main() {
    int index = int(gl_GlobalInvocationID.x);
    if (index >= count) {
        return;
    }
    Particle p = read_particle(index);
    vec4 shape = look_texel(p.look, 0u);
    vec4 streak = look_texel(p.look, 1u);
    vec4 glow = look_texel(p.look, 2u);
    float tumble = look_texel(p.look, kLookMore).w;
    if (look_texel(p.look, kLookFocus).y == 0.0) {
        return;
    }
    float size = size_of(p, shape);
    Quad quad = quad_of(p, shape, streak, tumble, int(glow.w), size);
    vec4 clip = view.clip_from_world * vec4(p.position, 1.0);
    vec2 pixel = (clip.xy / max(clip.w, 1e-6) * 0.5 + 0.5) * view.size.xy;
    float ahead = max(clip.w, view.camera_ws.w);
    vec3 light =
        scattered_light(p.position, corner_normals(p.position, quad), streak.w, 0.5 * size, pixel, ahead);
    center_light[index] = vec4(glow.y * light, 0.0);
}
