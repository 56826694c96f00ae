// A particle and its look (particle_gpu.h), for shaders that draw it as a quad.

#include "lib/periodic.glsl"
#include "particle_gpu.h"

layout(binding = kParticlesUnit) uniform usamplerBuffer particles;
layout(binding = kLooksUnit) uniform samplerBuffer looks;

const int kFacingCamera = 0;  // ParticleFacing
const int kFacingVelocity = 1;
const int kFacingGround = 2;
const int kFacingPixels = 3;

const int kFramesShuffle = 1;
const int kFramesPick = 2;

struct Particle {
    vec3 position;  // [m]
    vec3 velocity;  // [m/s]
    float age;      // [s]
    float life_fraction;
    int look;
    uint random;
    bool is_dead;
    int record;     // of a segment of a ribbon: the point before it; of a billboard: its quad
    float opacity;  // of a billboard
};

Particle read_particle(int index) {
    uint words[kParticleWords];
    for (int i = 0; i < int(kParticleWords); ++i) {
        words[i] = texelFetch(particles, index * int(kParticleWords) + i).x;
    }
    vec3 position = uintBitsToFloat(uvec3(words[0], words[1], words[2]));
    vec2 velocity_xy = unpackHalf2x16(words[4]);
    vec2 velocity_z_age = unpackHalf2x16(words[5]);
    return Particle(position, vec3(velocity_xy, velocity_z_age.x), velocity_z_age.y, float(words[3] & 0xffffu) / 65535.0,
                    int(words[3] >> 16), words[6], velocity_z_age.y < 0.0, int(words[4]), uintBitsToFloat(words[5]));
}

// Half the extents of a quad in world space: along x and y of its corners.
struct Quad {
    vec3 right;
    vec3 up;
};

// The corners of a quad as a triangle strip, -1 .. 1.
vec2 corner_of(int vertex) {
    return 2.0 * vec2(vertex & 1, vertex >> 1) - 1.0;
}

float random_signed(uint bits, uint index) {  // -1 .. 1
    uint h = (bits + index * 0x9e3779b9u) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    return float(h >> 8) * (2.0 / 16777216.0) - 1.0;
}

vec4 look_texel(int look, uint texel) {
    return texelFetch(looks, look * int(kLookTexels) + int(texel));
}

// The texels of a look that most shapes need: 0 to 3, and kLookMore (particle_gpu.h).
struct Look {
    int index;
    vec4 shape;
    vec4 streak;
    vec4 glow;
    vec4 book;
    vec4 more;
};

Look read_look(int index) {
    return Look(index, look_texel(index, 0u), look_texel(index, 1u), look_texel(index, 2u), look_texel(index, 3u),
                look_texel(index, kLookMore));
}

float size_factor(int look, float at) {
    int i = min(int(at), int(kLookSamples) - 2);
    float a = look_texel(look, kLookSizes + uint(i >> 2))[i & 3];
    float b = look_texel(look, kLookSizes + uint((i + 1) >> 2))[(i + 1) & 3];
    return mix(a, b, at - float(i));
}

// Diameter [m]; `shape`: texel 0 of the look.
float size_of(Particle p, vec4 shape) {
    return max(shape.x + shape.y * random_signed(p.random, 0u), 0.0)
           * size_factor(p.look, p.life_fraction * float(kLookSamples - 1u));
}

// Color and opacity at its age, without the fades by distance.
vec4 color_of(Particle p) {
    vec4 wave = look_texel(p.look, kLookMore + 2u);
    vec4 varied = look_texel(p.look, kLookMore + 3u);
    float at_life = p.life_fraction;
    bool has_age = uint(look_texel(p.look, 2u).w) < kFacingRibbon;
    if (has_age && p.age >= 0.0 && (wave.y != 0.0 || wave.z != 0.0)) {
        at_life = clamp(wave.y + wave.z * periodic_wave(int(wave.x), varied.x * p.age, wave.w), 0.0, 1.0);
    }
    float at = at_life * float(kLookSamples - 1u);
    int i = min(int(at), int(kLookSamples) - 2);
    vec4 color = mix(look_texel(p.look, kLookColors + uint(i)), look_texel(p.look, kLookColors + uint(i) + 1u),
                     at - float(i));
    if (varied.yzw != vec3(0.0)) {
        vec3 chance = vec3(random_signed(p.random, 6u), random_signed(p.random, 7u), random_signed(p.random, 8u));
        color.rgb = max(color.rgb + varied.yzw * chance, vec3(0.0));
    }
    float fade = look_texel(p.look, kLookMore + 1u).w;
    if (fade > 0.0 && p.life_fraction > 0.0) {
        color.a *= clamp(p.age * (1.0 - p.life_fraction) / (p.life_fraction * fade), 0.0, 1.0);
    }
    return color;
}

// Angle of the quad [rad]; `streak`: texel 1 of the look.
float angle_of(Particle p, vec4 shape, vec4 streak) {
    return shape.z * random_signed(p.random, 1u) + (shape.w + streak.x * random_signed(p.random, 2u)) * p.age;
}

struct Flipbook {
    vec4 frames;     // texture coordinates: scale xy, offset of the frame zw
    vec2 next;       // offset of the next frame
    float progress;  // toward it, 0 .. 1
    vec2 numbers;    // of the frame and the next one
};
// The frame that it shows, with a fraction; `book`: texel 3 of the look; `kind`: ParticleFrames.
float frame_shown(Particle p, vec4 book, int kind) {
    float count = book.x * book.y;
    float shown = book.z > 0.0 ? p.age * book.z : p.life_fraction * (count - 1.0);
    float chance = floor((0.5 + 0.5 * random_signed(p.random, 5u)) * count);
    return kind == kFramesPick ? chance : kind == kFramesShuffle ? shown + chance : shown;
}
Flipbook flipbook_at(float shown, vec4 book, int kind) {
    float count = book.x * book.y;
    bool loops = book.z > 0.0 || kind == kFramesShuffle;
    float frame = mod(floor(shown), count);
    float next = loops ? mod(frame + 1.0, count) : min(frame + 1.0, count - 1.0);
    return Flipbook(vec4(1.0 / book.xy, vec2(mod(frame, book.x), floor(frame / book.x)) / book.xy),
                    vec2(mod(next, book.x), floor(next / book.x)) / book.xy, count > 1.0 ? fract(shown) : 0.0,
                    vec2(frame, next));
}
Flipbook flipbook_of(Particle p, vec4 book, int kind) {
    return flipbook_at(frame_shown(p, book, kind), book, kind);
}
