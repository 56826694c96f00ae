// Strokes along lines of constant texture coordinates, as the lightest tone 0 .. 1 that has ink at a point; 0: none has
// (hatching_pass.h). Include after lib/view.glsl.
//
// Lines are numbered at a spacing so fine that none is drawn there; those with numbers that are divisible by 2^n are
// those of level n. Of the two levels whose spacings in the image enclose the wanted one, the finer fades out toward
// the coarser. Lines of coarser levels are in lighter tones.
// Techniques: tex.hatching

const float kFinestLines = 4096.0;   // per unit of texture coordinates
const float kStrokeSpacing = 4.0;    // in the darkest tone [px of an image 720 lines high]
const float kStrokeWidth = 1.2;      // [px of the same]
const float kMinScale = 0.6;         // lower limit of image height / 720, which keeps strokes of small images apart
const float kStrokeLength = 24.0;    // per unit of texture coordinates, between noise values

float hatching_random(ivec2 cell, uint seed) {
    uint h = uint(cell.x) * 0x85ebca6bu ^ uint(cell.y) * 0xc2b2ae35u ^ seed * 0x9e3779b9u;
    h = (h ^ h >> 15) * 0x27d4eb2fu;
    return float((h ^ h >> 13) & 0xffffu) / 65535.0;
}

// Smooth noise 0 .. 1. Not that of lib/noise.glsl, which the programs of all materials would include.
float hatching_noise(vec2 p, uint seed) {
    ivec2 cell = ivec2(floor(p));
    vec2 t = p - floor(p);
    t = t * t * (3.0 - 2.0 * t);
    float low = mix(hatching_random(cell, seed), hatching_random(cell + ivec2(1, 0), seed), t.x);
    float high = mix(hatching_random(cell + ivec2(0, 1), seed), hatching_random(cell + 1, seed), t.x);
    return mix(low, high, t.y);
}

// Lightest tone with a line, by its rank: the levels above the finest one drawn at which it still exists. Continuous: -1
// for a line that has just faded out.
float tone_of_rank(float rank) {
    return clamp(0.3 * (rank + 1.0) - 0.05, 0.0, 0.92);
}

// One family of parallel strokes: `across` counts lines, `along` runs along them; `scale`: size of a stroke.
float stroke_family(float across, float along, float scale, uint seed) {
    float lines = across * kFinestLines;
    float per_pixel = max(length(vec2(dFdx(lines), dFdy(lines))), 1e-6);
    float level = max(log2(per_pixel * kStrokeSpacing * scale), 0.0);
    float finest = exp2(floor(level));
    float number = floor(lines / finest + 0.5);
    int line = int(number) & 0xffff;
    float rank = float(line == 0 ? 15 : findLSB(line)) - fract(level);
    float hand = hatching_noise(vec2(along * kStrokeLength, number * finest), seed);  // pressure along the line
    float half_width = 0.5 * kStrokeWidth * scale * (0.55 + 0.9 * hand);
    float distance = abs(lines / finest - number) * finest / per_pixel;
    float covered = clamp(half_width + 0.5 - distance, 0.0, 1.0);
    return tone_of_rank(rank - 0.8 * (1.0 - hand)) * covered;
}

// Strokes of a surface: along u, slanting across them where it is darker, and along v in the deepest shade.
float hatching_tone(vec2 uv) {
    float scale = max(view.size.y / 720.0, kMinScale);
    vec2 wander = vec2(hatching_noise(uv * 5.0, 3u), hatching_noise(uv * 5.0, 4u)) - 0.5;  // lines drawn by hand
    uv += 0.006 * wander;
    float along_u = stroke_family(uv.y, uv.x, scale, 11u);
    float slanting = 0.68 * stroke_family(0.82 * uv.x + 0.57 * uv.y, 0.82 * uv.y - 0.57 * uv.x, scale, 12u);
    float along_v = 0.4 * stroke_family(uv.x, uv.y, scale, 13u);
    return max(along_u, max(slanting, along_v));
}
