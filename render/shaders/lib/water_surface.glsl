// What moves the surface of a body of water, as evaluate_waves() and sample_ripples() of systems/water have it: the
// point at rest at q = (x, z), in the water's own space, is displaced by the sum of all.

#include "water_gpu.h"

layout(binding = 1) uniform samplerBuffer waters;      // WaterRecord
layout(binding = 2) uniform samplerBuffer wave_lines;  // WaveLineRecord
layout(binding = 3) uniform samplerBuffer wave_rings;  // WaveRingRecord
layout(binding = 4) uniform sampler2D ripple_atlas;    // height, velocity, slopes (ripple_atlas.h)
#ifdef OCEAN  // ocean_textures.h
layout(binding = 6) uniform sampler2DArray ocean_shift;         // shift_x, height, shift_z at the moment shown
layout(binding = 13) uniform sampler2DArray ocean_shift_before;  // at the moment before
layout(binding = 14) uniform sampler2DArray ocean_slope;        // slope_x, slope_z, shift_xx, shift_zz
layout(binding = 17) uniform sampler2DArray ocean_foam;         // shift_xz, foam
#endif

WaterRecord water_record(int body) {
    int first = body * int(kWaterTexels);
    return WaterRecord(
        texelFetch(waters, first),
        texelFetch(waters, first + 1),
        texelFetch(waters, first + 2),
        texelFetch(waters, first + 3),
        texelFetch(waters, first + 4),
        texelFetch(waters, first + 5),
        texelFetch(waters, first + 6),
        texelFetch(waters, first + 7),
        texelFetch(waters, first + 8),
        texelFetch(waters, first + 9));
}

vec3 water_to_world(WaterRecord water, vec3 v) {
    vec2 x = vec2(water.origin.w, water.shape.x);
    return vec3(x.x * v.x - x.y * v.z, v.y, x.y * v.x + x.x * v.z);
}
vec3 world_to_water(WaterRecord water, vec3 v) {
    vec2 x = vec2(water.origin.w, water.shape.x);
    return vec3(x.x * v.x + x.y * v.z, v.y, x.x * v.z - x.y * v.x);
}

vec4 ripples_at(WaterRecord water, vec2 q) {
    bool inside = all(lessThanEqual(abs(q), water.rippling.xy));
    vec4 texel = textureLod(ripple_atlas, q * water.ripples.xy + water.ripples.zw, 0.0);
    return inside ? texel : vec4(0.0);
}

#ifdef OCEAN
// Texture coordinates of a patch: point 0 is the middle of texel 0.
vec3 ocean_place(WaterRecord water, int i, vec2 q) {
    return vec3(q * water.patches[i] + 0.5 / water.ocean.z, water.ocean.x + float(i));
}
#endif

// Share of waves of wave number k that points `spacing` [m] apart still show: none of those with less than two points.
float wave_share(float k, float spacing) {
    return 1.0 - smoothstep(0.25, 0.5, spacing * k * 0.159154943);
}

// Where the point at rest at q is, as points `spacing` [m] apart show it; at the moment shown or the moment `before`.
vec3 water_offset(WaterRecord water, vec2 q, float spacing, bool before) {
    vec3 offset = vec3(0.0);
#ifdef OCEAN
    int patches = int(water.ocean.y);
    for (int i = 0; i < patches; ++i) {
        vec3 place = ocean_place(water, i, q);
        float level = log2(max(spacing * water.patches[i] * water.ocean.z, 1.0));
        offset += (before ? textureLod(ocean_shift_before, place, level) : textureLod(ocean_shift, place, level)).xyz;
    }
#endif
    int line = int(water.waves.x);
    int end = line + int(water.waves.y);
    for (; line < end; ++line) {
        vec4 run = texelFetch(wave_lines, line * int(kWaveLineTexels));
        vec4 wave = texelFetch(wave_lines, line * int(kWaveLineTexels) + 1);
        float share = wave_share(length(run.xy), spacing);
        float phase = dot(run.xy, q) + (before ? wave.y : wave.x);
        float leaning = wave.w * max(sin(phase), 0.0);
        offset += share * vec3(run.z * cos(phase), wave.z * sin(phase - leaning), run.w * cos(phase));
    }
    int ring = int(water.waves.z);
    end = ring + int(water.waves.w);
    for (; ring < end; ++ring) {
        vec4 place = texelFetch(wave_rings, ring * int(kWaveRingTexels));
        vec4 wave = texelFetch(wave_rings, ring * int(kWaveRingTexels) + 1);
        vec4 fade = texelFetch(wave_rings, ring * int(kWaveRingTexels) + 2);
        vec2 edges = place.zw + (before ? fade.z : 0.0);
        float r = distance(q, place.xy);
        float window = fade.y > 0.5 ? sin(kPi * (r - edges.x) / (edges.y - edges.x)) : 1.0;
        float faded = fade.x > 0.0 ? sqrt(min(fade.x / max(r, 1e-6), 1.0)) : 1.0;
        float height = wave.w * wave_share(wave.z, spacing) * faded * window * window * sin(wave.z * r + (before ? wave.y : wave.x));
        offset.y += r >= edges.x && r <= edges.y ? height : 0.0;
    }
    vec4 ripples = ripples_at(water, q);
    offset.y += ripples.x + ripples.y * (before ? water.rippling.w : water.rippling.z);
    return offset;
}

// How the offset changes along x and along z.
struct WaterBend {
    vec3 by_x;
    vec3 by_z;
    float variance;  // of slopes that are too fine to be seen
    float foam;      // 0 .. 1
};

// By waves of closed form, as points `spacing` [m] apart show them.
WaterBend wave_bend(WaterRecord water, vec2 q, float spacing) {
    WaterBend bend = WaterBend(vec3(0.0), vec3(0.0), 0.0, 0.0);
    int line = int(water.waves.x);
    int end = line + int(water.waves.y);
    for (; line < end; ++line) {
        vec4 run = texelFetch(wave_lines, line * int(kWaveLineTexels));
        vec4 wave = texelFetch(wave_lines, line * int(kWaveLineTexels) + 1);
        float k = length(run.xy);
        float share = wave_share(k, spacing);
        float phase = dot(run.xy, q) + wave.x;
        float s = sin(phase);
        float c = cos(phase);
        float lean = s > 0.0 ? wave.w : 0.0;
        float rise = wave.z * cos(phase - lean * s) * (1.0 - lean * c);
        vec3 by_phase = share * vec3(-run.z * s, rise, -run.w * s);
        bend.by_x += run.x * by_phase;
        bend.by_z += run.y * by_phase;
        bend.variance += (1.0 - share * share) * 0.5 * wave.z * wave.z * k * k;
    }
    int ring = int(water.waves.z);
    end = ring + int(water.waves.w);
    for (; ring < end; ++ring) {
        vec4 place = texelFetch(wave_rings, ring * int(kWaveRingTexels));
        vec4 wave = texelFetch(wave_rings, ring * int(kWaveRingTexels) + 1);
        vec4 fade = texelFetch(wave_rings, ring * int(kWaveRingTexels) + 2);
        vec2 out_from = q - place.xy;
        float r = max(length(out_from), 1e-6);
        float rate = fade.y > 0.5 ? kPi / (place.w - place.z) : 0.0;
        float u = rate * (r - place.z);
        float window = fade.y > 0.5 ? sin(u) * sin(u) : 1.0;
        float window_slope = rate * sin(2.0 * u);
        bool fading = fade.x > 0.0 && r > fade.x;
        float faded = fading ? sqrt(fade.x / r) : 1.0;
        float phase = wave.z * r + wave.x;
        float slope = wave.w * wave_share(wave.z, spacing) * faded
                      * (wave.z * cos(phase) * window + sin(phase) * window_slope
                         - sin(phase) * window * (fading ? 0.5 / r : 0.0));
        slope = r >= place.z && r <= place.w ? slope : 0.0;
        bend.by_x.y += slope * out_from.x / r;
        bend.by_z.y += slope * out_from.y / r;
    }
    return bend;
}

// By ripples and seas; of seas the mean over `footprint` [m].
WaterBend field_bend(WaterRecord water, vec2 q, float footprint) {
    WaterBend bend = WaterBend(vec3(0.0), vec3(0.0), 0.0, 0.0);
#ifdef OCEAN
    int patches = int(water.ocean.y);
    int i = 0;
    float share = patches > 0 ? 1.0 : 0.0;
    // Asks after its body, see add_directional().
    do {
        vec3 place = patches > 0 ? ocean_place(water, i, q) : vec3(0.0);
        float level = max(log2(footprint * water.patches[i] * water.ocean.z), 0.0);
        vec4 slope = textureLod(ocean_slope, place, level);
        vec2 cross_foam = textureLod(ocean_foam, place, level).xy;
        bend.by_x += share * vec3(slope.z, slope.x, cross_foam.x);
        bend.by_z += share * vec3(cross_foam.x, slope.y, slope.w);
        bend.foam += share * cross_foam.y;
        bend.variance += water.variance[i] * clamp(level * 0.3, 0.0, 1.0);
    } while (++i < patches);
    bend.foam = min(bend.foam, 1.0);
#endif
    vec2 slopes = ripples_at(water, q).zw;
    bend.by_x.y += slopes.x;
    bend.by_z.y += slopes.y;
    return bend;
}

// By all; of seas the mean over `footprint` [m].
WaterBend water_bend(WaterRecord water, vec2 q, float footprint) {
    WaterBend waves = wave_bend(water, q, 0.0);
    WaterBend bend = field_bend(water, q, footprint);
    bend.by_x += waves.by_x;
    bend.by_z += waves.by_z;
    return bend;
}

// Up, unit, in the water's own space.
vec3 water_normal(WaterBend bend) {
    return normalize(cross(vec3(0.0, 0.0, 1.0) + bend.by_z, vec3(1.0, 0.0, 0.0) + bend.by_x));
}
