// Colors and patterns of a dressed person (material_dress_gpu.h). Patterns are averaged over the footprint of the pixel,
// an axis at a time, so that they fade into their mean where they are small. Light of vertices or facets
// (rendering.shading) is colored per pixel, too.
// Techniques: engine.multi-material

#include "material_dress_gpu.h"

// DressedPart, by the alpha of the vertex color.
uint person_part(float alpha) {
    return alpha > 0.9 ? kPersonOther : uint(clamp((0.875 - alpha) / 0.15, 0.0, float(kPersonOther)));
}

// Mean over [x - w / 2, x + w / 2] of a wave of period 1 that is 1 in [0, duty) and else 0.
vec2 mean_pulse(vec2 x, vec2 w, float duty) {
    vec2 width = max(w, vec2(1e-3));
    vec2 a = x - 0.5 * width;
    vec2 b = x + 0.5 * width;
    return (floor(b) * duty + min(fract(b), vec2(duty)) - floor(a) * duty - min(fract(a), vec2(duty))) / width;
}

// Share of the ink at `at`, in periods; `width`: of the pixel.
float cloth_ink(int pattern, vec2 at, vec2 width) {
    float slant = abs(fract(at.x) - 0.5);
    float blurred = min(max(width.x, width.y), 1.0);
    vec2 x = at;
    vec2 w = width;
    if (pattern == kPatternKnit) {
        x.y += mix(slant, 0.25, blurred);
    } else if (pattern == kPatternTwill) {
        x.x += x.y;
        w.x += w.y;
    }
    vec2 half_wave = mean_pulse(x, w, 0.5);
    vec2 lines = mean_pulse(x + vec2(0.3), w, 0.08);
    vec2 cell = fract(at) - 0.5;
    float dot_share = 1.0 - smoothstep(0.28 - 0.5 * blurred, 0.28 + 0.5 * blurred + 1e-4, length(cell));
    return pattern == kPatternStripes || pattern == kPatternTwill ? half_wave.x
           : pattern == kPatternBands || pattern == kPatternKnit  ? half_wave.y
           : pattern == kPatternChecks                            ? 0.5 * (half_wave.x + half_wave.y)
           : pattern == kPatternPlaid ? 0.3 * (half_wave.x + half_wave.y) + 0.2 * (lines.x + lines.y)
           : pattern == kPatternDots  ? mix(dot_share, 0.246, smoothstep(0.4, 1.0, blurred))
                                      : 0.0;
}

// Factor of the color of a part, at texture coordinates in meters.
vec3 dress_factor(uint material, float alpha, vec2 at) {
    vec2 pixel = fwidth(at);
    uint part = person_part(alpha);
    if (part == kPersonOther) {
        return vec3(1.0);
    }
    int first = block_begin(material, kDressBlock);
    vec4 factor = texelFetch(materials, first + int(part));
    if (part < kPersonShirt) {
        return factor.rgb;
    }
    vec4 ink = texelFetch(materials, first + 2 + int(part));
    return mix(factor.rgb, ink.rgb, cloth_ink(int(ink.w), at / factor.w, pixel / factor.w));
}
