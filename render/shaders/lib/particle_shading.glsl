// Light that a particle emits and scatters, in fog: part of lib/particle_corner.glsl. Definitions: those of
// lib/lighting.glsl, and
//   LIT         some particle scatters light that is evaluated at its corners
//   LIT_CENTER  some scatters light that particle_light.comp has evaluated
//   SIX_WAY     some have images of the light from six sides
//   IN_WATER    without fog, which the water that is drawn over them gets
#ifdef LIT
#include "lib/particle_scattering.glsl"
#endif
#ifdef SIX_WAY
#include "lib/particle_six_way.glsl"
#endif
#ifdef LIT_CENTER
layout(binding = kCenterLightUnit) uniform samplerBuffer center_light;  // of each particle to draw
#endif

// Projection of a position: pixel [px], distance along the view axis [m].
vec3 pixel_and_distance(vec3 position_ws) {
    vec4 clip = view.clip_from_world * vec4(position_ws, 1.0);
    vec2 pixel = (clip.xy / max(clip.w, 1e-6) * 0.5 + 0.5) * view.size.xy;
    return vec3(pixel, max(clip.w, view.camera_ws.w));
}

// Radiance of a white particle.
vec3 particle_radiance(Particle p, Look look, ParticleCorner c, int index) {
    vec3 radiance = vec3(look.glow.x);
    bool is_lit = look.glow.y > 0.0;
#ifdef LIT_CENTER
    bool is_lit_once = look_texel(look.index, kLookFocus).y > 0.0;
    radiance += is_lit_once ? texelFetch(center_light, index).rgb : vec3(0.0);
    is_lit = is_lit && !is_lit_once;
#endif
#ifdef SIX_WAY
    is_lit = is_lit && !is_six_way(look);
#endif
#ifdef LIT
    if (is_lit) {
        vec3 at = pixel_and_distance(p.position);
        radiance += look.glow.y
                    * scattered_light(lit_position(p, c.offset), c.normal, look.streak.w, 0.5 * c.size, at.xy, at.z);
    }
#endif
    return radiance;
}

void write_shading(Particle p, Look look, ParticleCorner c, int index) {
    vec3 radiance = particle_radiance(p, look, c, index);
    light = vec4(c.color.rgb * radiance * c.color.a, c.color.a);
#ifdef SIX_WAY
    write_six_way(p, look, c, pixel_and_distance(p.position));
#endif
#ifndef IN_WATER
    vec4 fog = fog_before(p.position);
    vec3 veil = fog.rgb * (c.color.a * look.glow.z);
    light.rgb = light.rgb * (1.0 - fog.a) + veil;
#ifdef SIX_WAY
    add_fog_to_six_way(1.0 - fog.a, veil);
#endif
#endif
}
