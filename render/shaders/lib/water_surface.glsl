// Displacement of a water surface, the same as evaluate_waves() and sample_ripples() of systems/water: the point at
// rest at q = (x, z), in water space, is displaced by the sum of all waves.

#include "water_gpu.h"

layout(binding = kWatersUnit) uniform samplerBuffer waters;      // WaterRecord
layout(binding = kWaveLinesUnit) uniform samplerBuffer wave_lines;  // WaveLineRecord
layout(binding = kWaveRingsUnit) uniform samplerBuffer wave_rings;  // WaveRingRecord
layout(binding = kRippleAtlasUnit) uniform sampler2D ripple_atlas;    // height, velocity, slopes (ripple_atlas.h)
#ifdef OCEAN  // ocean_textures.h
layout(binding = kOceanShiftUnit) uniform sampler2DArray ocean_shift;         // shift_x, height, shift_z, current
layout(binding = kPreviousOceanShiftUnit) uniform sampler2DArray previous_ocean_shift;  // previous frame
layout(binding = kOceanSlopeUnit) uniform sampler2DArray ocean_slope;        // slope_x, slope_z, shift_xx, shift_zz
layout(binding = kOceanFoamUnit) uniform sampler2DArray ocean_foam;         // shift_xz, foam
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
        texelFetch(waters, first + 9),
        texelFetch(waters, first + 10));
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
    // Without a grid not even at the origin: an atlas without ripples is undefined.
    bool inside = water.rippling.x > 0.0 && all(lessThanEqual(abs(q), water.rippling.xy));
    vec4 texel = textureLod(ripple_atlas, q * water.ripples.xy + water.ripples.zw, 0.0);
    return inside ? texel : vec4(0.0);
}

#ifdef OCEAN
// Texture coordinates in a patch: point 0 is the center of texel 0.
vec3 ocean_patch_uv(WaterRecord water, int i, vec2 q) {
    return vec3(q * water.patches[i] + 0.5 / water.ocean.z, water.ocean.x + float(i));
}
#endif

// Fraction of the amplitude of waves of wave number k that points `spacing` [m] apart resolve: 0 below two points per
// wave.
float resolved_fraction(float k, float spacing) {
    return 1.0 - smoothstep(0.25, 0.5, spacing * k * 0.159154943);
}

// Derivatives of the offset by x and by z.
struct WaterBend {
    vec3 by_x;
    vec3 by_z;
    float variance;  // of unresolved slopes
    float foam;      // 0 .. 1
};

struct WaterMotion {
    vec3 offset;  // from the point at rest [m]
    WaterBend bend;
};

// Adds a wave with straight crests, current or in the previous frame (`previous`); `exists`: 0 or 1.
void add_line(inout WaterMotion motion, int line, float exists, vec2 q, float spacing, bool previous) {
    vec4 run = texelFetch(wave_lines, line * int(kWaveLineTexels));
    vec4 wave = texelFetch(wave_lines, line * int(kWaveLineTexels) + 1);
    float k = length(run.xy);
    float amplitude = exists * resolved_fraction(k, spacing);
    float phase = dot(run.xy, q) + (previous ? wave.y : wave.x);
    float s = sin(phase);
    float c = cos(phase);
    float lean = s > 0.0 ? wave.w : 0.0;
    float leaning = phase - lean * s;
    motion.offset += amplitude * vec3(run.z * c, wave.z * sin(leaning), run.w * c);
    vec3 by_phase = amplitude * vec3(-run.z * s, wave.z * cos(leaning) * (1.0 - lean * c), -run.w * s);
    motion.bend.by_x += run.x * by_phase;
    motion.bend.by_z += run.y * by_phase;
    motion.bend.variance += (exists - amplitude * amplitude) * 0.5 * wave.z * wave.z * k * k;
}

// Adds a wave around a point.
void add_ring(inout WaterMotion motion, int ring, float exists, vec2 q, float spacing, bool previous) {
    vec4 circle = texelFetch(wave_rings, ring * int(kWaveRingTexels));
    vec4 wave = texelFetch(wave_rings, ring * int(kWaveRingTexels) + 1);
    vec4 fade = texelFetch(wave_rings, ring * int(kWaveRingTexels) + 2);
    vec2 edges = circle.zw + (previous ? fade.z : 0.0);
    vec2 out_from = q - circle.xy;
    float r = max(length(out_from), 1e-6);
    float rate = fade.y > 0.5 ? kPi / max(edges.y - edges.x, 1e-6) : 0.0;
    float u = rate * (r - edges.x);
    float s = sin(u);
    float window = fade.y > 0.5 ? s * s : 1.0;
    float window_slope = 2.0 * rate * s * cos(u);
    bool fading = fade.x > 0.0 && r > fade.x;
    float faded = fading ? sqrt(fade.x / r) : 1.0;
    float phase = wave.z * r + (previous ? wave.y : wave.x);
    float height = sin(phase);
    float size = r >= edges.x && r <= edges.y ? exists * wave.w * resolved_fraction(wave.z, spacing) * faded : 0.0;
    motion.offset.y += size * window * height;
    float slope = size * (wave.z * cos(phase) * window + height * window_slope
                          - height * window * (fading ? 0.5 / r : 0.0));
    motion.bend.by_x.y += slope * out_from.x / r;
    motion.bend.by_z.y += slope * out_from.y / r;
}

// Motion by analytic waves, as points `spacing` [m] apart resolve them, current or in the previous frame (`previous`).
WaterMotion wave_motion(WaterRecord water, vec2 q, float spacing, bool previous) {
    WaterMotion motion = WaterMotion(vec3(0.0), WaterBend(vec3(0.0), vec3(0.0), 0.0, 0.0));
    // Loops test after their body, see add_directional(). Without waves they read an existing wave or zeros, which add
    // nothing.
    int line = min(int(water.waves.x), textureSize(wave_lines) / int(kWaveLineTexels) - 1);
    int end = line + int(water.waves.y);
    float exists = water.waves.y > 0.0 ? 1.0 : 0.0;
    do {
        add_line(motion, line, exists, q, spacing, previous);
    } while (++line < end);
    int ring = min(int(water.waves.z), textureSize(wave_rings) / int(kWaveRingTexels) - 1);
    end = ring + int(water.waves.w);
    exists = water.waves.w > 0.0 ? 1.0 : 0.0;
    do {
        add_ring(motion, ring, exists, q, spacing, previous);
    } while (++ring < end);
    return motion;
}

// Offset by ripples and ocean patches, as points `spacing` [m] apart resolve them.
vec3 field_offset(WaterRecord water, vec2 q, float spacing, bool previous) {
    vec3 offset = vec3(0.0);
#ifdef OCEAN
    int patches = int(water.ocean.y);
    float exists = patches > 0 ? 1.0 : 0.0;
    int i = 0;
    do {
        vec3 uv = patches > 0 ? ocean_patch_uv(water, i, q) : vec3(0.0);
        float level = log2(max(spacing * water.patches[i] * water.ocean.z, 1.0));
        offset += exists
                  * (previous ? textureLod(previous_ocean_shift, uv, level)
                              : textureLod(ocean_shift, uv, level)).xyz;
    } while (++i < patches);
#endif
    vec4 ripples = ripples_at(water, q);
    offset.y += ripples.x + ripples.y * (previous ? water.rippling.w : water.rippling.z);
    return offset;
}

// Offset of the point at rest at q.
vec3 water_offset(WaterRecord water, vec2 q, float spacing, bool previous) {
    return wave_motion(water, q, spacing, previous).offset + field_offset(water, q, spacing, previous);
}

// Derivatives by ripples and ocean patches; the latter averaged over `footprint` [m].
WaterBend field_bend(WaterRecord water, vec2 q, float footprint) {
    WaterBend bend = WaterBend(vec3(0.0), vec3(0.0), 0.0, 0.0);
#ifdef OCEAN
    int patches = int(water.ocean.y);
    int i = 0;
    float exists = patches > 0 ? 1.0 : 0.0;
    // Tests after its body, see add_directional().
    do {
        vec3 uv = patches > 0 ? ocean_patch_uv(water, i, q) : vec3(0.0);
        float level = max(log2(footprint * water.patches[i] * water.ocean.z), 0.0);
        vec4 slope = textureLod(ocean_slope, uv, level);
        vec2 cross_foam = textureLod(ocean_foam, uv, level).xy;
        bend.by_x += exists * vec3(slope.z, slope.x, cross_foam.x);
        bend.by_z += exists * vec3(cross_foam.x, slope.y, slope.w);
        bend.foam += exists * cross_foam.y;
        bend.variance += water.variance[i] * clamp(level * 0.3, 0.0, 1.0);
    } while (++i < patches);
    bend.foam = min(bend.foam, 1.0);
#endif
    vec2 slopes = ripples_at(water, q).zw;
    bend.by_x.y += slopes.x;
    bend.by_z.y += slopes.y;
    return bend;
}

// Current motion by all waves, as points `spacing` [m] apart resolve it; ocean patches are averaged over as much.
WaterMotion water_motion(WaterRecord water, vec2 q, float spacing) {
    WaterMotion motion = wave_motion(water, q, spacing, false);
    WaterBend bend = field_bend(water, q, spacing);
    motion.offset += field_offset(water, q, spacing, false);
    motion.bend.by_x += bend.by_x;
    motion.bend.by_z += bend.by_z;
    return motion;
}

// Upward, unit, in water space.
vec3 water_normal(WaterBend bend) {
    return normalize(cross(vec3(0.0, 0.0, 1.0) + bend.by_z, vec3(1.0, 0.0, 0.0) + bend.by_x));
}
