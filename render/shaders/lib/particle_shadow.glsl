// Transmittance of light through particles. Definition:
//   PARTICLE_SHADOWS  1: they shadow the directional light, 2: a spot
// Techniques: particle.shadow

#include "lib/fourier_opacity.glsl"
#include "particle_gpu.h"

layout(binding = kParticleOpacityUnit) uniform sampler2DArray particle_opacity;  // two layers of coefficients, one of tints
layout(binding = kParticleShadowUnit) uniform samplerBuffer particle_shadow;    // ParticleShadowRecord

// Transmittance between light number `index` and `position_ws`.
vec3 particle_transmittance(int index, vec3 position_ws) {
    vec4 position = vec4(position_ws, 1.0);
    float q = dot(texelFetch(particle_shadow, 3), position);
    vec2 st = vec2(dot(texelFetch(particle_shadow, 0), position), dot(texelFetch(particle_shadow, 1), position)) / q;
    float depth = dot(texelFetch(particle_shadow, 2), position);
    OpacitySeries series = OpacitySeries(
        textureLod(particle_opacity, vec3(st, 0.0), 0.0), textureLod(particle_opacity, vec3(st, 1.0), 0.0));
    vec3 tinted = textureLod(particle_opacity, vec3(st, 2.0), 0.0).rgb;
    vec3 tint = tinted / max(0.5 * series.low.x, 1e-6);
    bool inside = q > 0.0 && all(greaterThan(st, vec2(0.0))) && all(lessThan(st, vec2(1.0)));
    bool shadowed = inside && index == int(texelFetch(particle_shadow, 4).x);
    return shadowed ? exp(-optical_depth(series, depth) * tint) : vec3(1.0);
}
