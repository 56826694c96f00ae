// Splats discs that only add light, one per invocation, into sums at the pixels that they cover. The sums are integers,
// so that they do not depend on the order (render/particles/particle_splats.h). One definition:
//   STEADY  looks of a constant size and color (is_steady), which are not read for each disc
// Techniques: particle.gpu-draw
#version 450
#include "lib/particle.glsl"
#include "lib/view.glsl"

#include "lib/height_fog.glsl"
#include "lib/particle_point.glsl"

layout(local_size_x = 128) in;  // kParticleGroup
layout(binding = kParticleDepthUnit) uniform sampler2D scene_depth;
layout(std430, binding = kSplatSumsBinding) buffer Sums {
    uint sums[];  // of red, green and blue of each pixel
};

uniform int count;
uniform float unit;  // of radiance, in the sums
uniform float max_amount;  // of a disc at a pixel, in units of the sums
#ifdef STEADY
uniform vec2 size_spread;   // diameter, give or take [m]
uniform vec4 steady_color;  // radiance at full opacity, opacity
#endif

struct Disc {
    vec2 center;   // [px]
    float radius;  // [px]
    float depth;
    vec3 light;    // at its center
    float chance;  // 0 .. 1
};

const float kLargest = 4.0;  // radius up to which a disc is drawn by one invocation; larger ones by the whole group [px]

shared Disc large[128];
shared uint large_count;

// Diameter [px], and radiance and opacity before it is made fainter for its size.
vec4 look_at(Particle p, out float diameter) {
#ifdef STEADY
    diameter = max(size_spread.x + size_spread.y * random_signed(p.random, 0u), 0.0) / pixel_extent(p.position);
    return steady_color;
#else
    vec4 glow = look_texel(p.look, 2u);
    float away = distance(p.position, view.camera_ws.xyz);
    float size = size_from(p, look_texel(p.look, 0u), int(glow.w), away);
    diameter = point_diameter(p.position, size, int(glow.w), away);
    vec4 color = color_from(p, away);
    return vec4(color.rgb * glow.x, color.a);
#endif
}

// Of radius 0 if it is not visible.
Disc disc_of(Particle p) {
    float diameter;
    vec4 color = look_at(p, diameter);
    color.a *= point_opacity(diameter);
    vec4 clip = view.clip_from_world * vec4(p.position, 1.0);
    bool is_visible = !p.is_dead && color.a > 0.0 && clip.w > 0.0 && clip.z <= clip.w;
    vec3 light = color.rgb * (color.a * (1.0 - fog_before(p.position).a));
    return Disc((clip.xy / clip.w * 0.5 + 0.5) * view.size.xy, is_visible ? 0.5 * max(diameter, kMinPoint) : 0.0,
                clip.z / clip.w, light, 0.5 + 0.5 * random_signed(p.random, 9u));
}

// Pixels whose centers are in the disc's bounding square: the first, and one past the last.
ivec4 pixels_of(Disc disc) {
    vec2 low = clamp(ceil(disc.center - disc.radius - 0.5), vec2(0.0), view.size.xy);
    vec2 high = clamp(ceil(disc.center + disc.radius - 0.5), vec2(0.0), view.size.xy);
    return ivec4(low, high);
}

bool is_behind(Disc disc, ivec2 pixel) {
    return texelFetch(scene_depth, pixel, 0).r > disc.depth;
}

void add(Disc disc, ivec2 pixel) {
    vec2 offset = (vec2(pixel) + 0.5 - disc.center) / disc.radius;
    float inside = max(1.0 - dot(offset, offset), 0.0);
    if (inside <= 0.0) {
        return;
    }
    float chance = fract(disc.chance + dot(vec2(pixel), vec2(0.7548777, 0.5698403)));  // Roberts 2018
    uvec3 amount = uvec3(min(disc.light * (inside * inside * unit), vec3(max_amount)) + chance);
    int first = 3 * (pixel.y * int(view.size.x) + pixel.x);
    for (int i = 0; i < 3; ++i) {
        atomicAdd(sums[first + i], amount[i]);
    }
}

void main() {
    int index = int(gl_GlobalInvocationID.x);
    if (gl_LocalInvocationIndex == 0u) {
        large_count = 0u;
    }
    barrier();
    Disc disc = Disc(vec2(0.0), 0.0, 0.0, vec3(0.0), 0.0);
    if (index < count) {
        disc = disc_of(read_particle(index));
    }
    if (disc.radius > kLargest) {
        large[atomicAdd(large_count, 1u)] = disc;
    } else if (disc.radius > 0.0) {
        ivec4 pixels = pixels_of(disc);
        bool is_small = disc.radius <= 0.5 * kMinPoint;  // as a whole before or behind what is at its center
        if (is_small && is_behind(disc, clamp(ivec2(disc.center), ivec2(0), ivec2(view.size.xy) - 1))) {
            pixels.w = pixels.y;
        }
        for (int y = pixels.y; y < pixels.w; ++y) {
            for (int x = pixels.x; x < pixels.z; ++x) {
                if (is_small || !is_behind(disc, ivec2(x, y))) {
                    add(disc, ivec2(x, y));
                }
            }
        }
    }
    barrier();
    for (uint i = 0u; i < large_count; ++i) {
        ivec4 pixels = pixels_of(large[i]);
        int width = pixels.z - pixels.x;
        int area = width * (pixels.w - pixels.y);
        for (int at = int(gl_LocalInvocationIndex); at < area; at += int(kParticleGroup)) {
            ivec2 pixel = pixels.xy + ivec2(at % width, at / width);
            if (!is_behind(large[i], pixel)) {
                add(large[i], pixel);
            }
        }
    }
}
