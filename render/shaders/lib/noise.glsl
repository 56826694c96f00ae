// Gradient noise in one, two or three dimensions, equal to ecs/base/gradient_noise.h (which explains it) to 1e-5; and
// per-pixel noise.
// Techniques: shade.noise, shade.stdlib

#include "lib/numbers.glsl"

uint lattice_hash(int x, int y, uint seed) {
    uint h = seed * 0x9e3779b9u ^ uint(x) * 0x85ebca6bu;
    h = (h ^ (h >> 15)) * 0xc2b2ae35u ^ uint(y) * 0x27d4eb2fu;
    h = (h ^ (h >> 13)) * 0x85ebca6bu;
    h = (h ^ (h >> 16)) * 0xc2b2ae35u;
    return h ^ (h >> 16);
}

float lattice_random(int x, int y, uint seed) {
    return float(lattice_hash(x, y, seed) >> 8) * (1.0 / 16777216.0);
}

vec3 quintic_fade(vec3 t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

float gradient_noise(float x, uint seed) {
    float cell = floor(x);
    float t = x - cell;
    float low = (2.0 * lattice_random(int(cell), 0, seed) - 1.0) * t;
    float high = (2.0 * lattice_random(int(cell) + 1, 0, seed) - 1.0) * (t - 1.0);
    return 2.0 * mix(low, high, quintic_fade(vec3(t)).x);
}

float noise_ramp(ivec2 cell, vec2 offset, uint seed) {
    const float kLong = 0.92387953;
    const float kShort = 0.38268343;
    const float kDiagonal = 0.70710678;
    uint h = lattice_hash(cell.x, cell.y, seed) >> 28;
    vec2 direction = h < 4u ? (h < 2u ? vec2(1.0, 0.0) : vec2(0.0, 1.0))
                     : h < 8u ? vec2(kLong, kShort)
                     : h < 12u ? vec2(kShort, kLong)
                               : vec2(kDiagonal);
    // For the first four, bit 0 flips their only coordinate.
    bvec2 turned = h < 4u ? bvec2((h & 1u) != 0u) : bvec2((h & 1u) != 0u, (h & 2u) != 0u);
    return dot(mix(direction, -direction, turned), offset);
}

float gradient_noise(vec2 p, uint seed) {
    vec2 cell = floor(p);
    vec2 t = p - cell;
    vec2 w = quintic_fade(vec3(t, 0.0)).xy;
    ivec2 c = ivec2(cell);
    float low = mix(noise_ramp(c, t, seed), noise_ramp(c + ivec2(1, 0), t - vec2(1.0, 0.0), seed), w.x);
    float high = mix(noise_ramp(c + ivec2(0, 1), t - vec2(0.0, 1.0), seed), noise_ramp(c + 1, t - 1.0, seed), w.x);
    return 1.41421356 * mix(low, high, w.y);
}

float noise_ramp(ivec2 cell, vec3 offset, uint plane) {
    uint h = lattice_hash(cell.x, cell.y, plane) >> 28;
    float u = h < 8u ? offset.x : offset.y;
    float v = h < 4u ? offset.y : h == 12u || h == 14u ? offset.x : offset.z;
    return ((h & 1u) != 0u ? -u : u) + ((h & 2u) != 0u ? -v : v);
}

float noise_plane(ivec2 cell, vec3 t, vec2 w, uint plane) {
    float a = noise_ramp(cell, t, plane);
    float b = noise_ramp(cell + ivec2(1, 0), t - vec3(1.0, 0.0, 0.0), plane);
    float c = noise_ramp(cell + ivec2(0, 1), t - vec3(0.0, 1.0, 0.0), plane);
    float d = noise_ramp(cell + 1, t - vec3(1.0, 1.0, 0.0), plane);
    return mix(mix(a, b, w.x), mix(c, d, w.x), w.y);
}

float gradient_noise(vec3 p, uint seed) {
    vec3 cell = floor(p);
    vec3 t = p - cell;
    vec3 w = quintic_fade(t);
    ivec3 c = ivec3(cell);
    float front = noise_plane(c.xy, t, w.xy, lattice_hash(c.z, 1, seed));
    float back = noise_plane(c.xy, t - vec3(0.0, 0.0, 1.0), w.xy, lattice_hash(c.z + 1, 1, seed));
    return 0.81649658 * mix(front, back, w.z);
}

bool has_fraction(float x) {
    return !is_nan(x) && abs(x) < 8388608.0;
}

// Noise in 0 .. 1 (shade.noise); octave i has frequency 2^i and amplitude 2^-i. 0.5 for NaN and where floats have no
// fraction left.
float noise(float x, uint seed, int octaves) {
    float sum = 0.0;
    float total = 0.0;
    float amplitude = 1.0;
    for (int i = 0; i < octaves; ++i) {
        sum += has_fraction(x) ? amplitude * gradient_noise(x, seed + uint(i)) : 0.0;
        total += amplitude;
        amplitude *= 0.5;
        x *= 2.0;
    }
    return 0.5 + 0.5 * sum / total;
}

float noise(vec2 p, uint seed, int octaves) {
    float sum = 0.0;
    float total = 0.0;
    float amplitude = 1.0;
    for (int i = 0; i < octaves; ++i) {
        bool there = has_fraction(p.x) && has_fraction(p.y);
        sum += there ? amplitude * gradient_noise(p, seed + uint(i)) : 0.0;
        total += amplitude;
        amplitude *= 0.5;
        p *= 2.0;
    }
    return 0.5 + 0.5 * sum / total;
}

float noise(vec3 p, uint seed, int octaves) {
    float sum = 0.0;
    float total = 0.0;
    float amplitude = 1.0;
    for (int i = 0; i < octaves; ++i) {
        bool there = has_fraction(p.x) && has_fraction(p.y) && has_fraction(p.z);
        sum += there ? amplitude * gradient_noise(p, seed + uint(i)) : 0.0;
        total += amplitude;
        amplitude *= 0.5;
        p *= 2.0;
    }
    return 0.5 + 0.5 * sum / total;
}

// Interleaved gradient noise in [0, 1) (Jimenez 2014): neighboring pixels differ strongly.
float pixel_noise(vec2 pixel) {
    return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715))));
}
