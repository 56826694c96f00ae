// From scene radiance to the display: luminance, curves, encodings and the dither before 8 bits.
// Techniques: hdr.compress, hdr.gamma, hdr.luminance, hdr.tonemap-shader

#include "lib/noise.glsl"
#include "lib/numbers.glsl"

// Of linear light (hdr.luminance). Rec. 709 has 0.2126, 0.7152, 0.0722.
float luminance(vec3 color) {
    return dot(color, vec3(0.27, 0.67, 0.06));
}

// Sanitizes radiance: NaN becomes black, infinity `max_light`, negative values 0.
vec3 sanitize_light(vec3 color, float max_light) {
    return mix(clamp(color, 0.0, max_light), vec3(0.0), is_nan(color));
}

// Khronos PBR neutral: the identity less a small toe up to 0.76, then compresses toward white and
// desaturates. Khronos Group, "PBR Neutral Tone Mapper", 2024.
vec3 tone_neutral(vec3 color) {
    const float kStart = 0.8 - 0.04;
    const float kDesaturation = 0.15;
    float low = min(color.r, min(color.g, color.b));
    float offset = low < 0.08 ? low - 6.25 * low * low : 0.04;
    color -= offset;
    float peak = max(color.r, max(color.g, color.b));
    float d = 1.0 - kStart;
    float new_peak = 1.0 - d * d / (max(peak, kStart) + d - kStart);
    float g = 1.0 - 1.0 / (kDesaturation * (max(peak, kStart) - new_peak) + 1.0);
    vec3 compressed = mix(color * (new_peak / max(peak, kStart)), vec3(new_peak), g);
    return peak < kStart ? color : compressed;
}

// Fit of the ACES reference and output transforms (Stephen Hill 2017), exposed so that 18 % gray stays 18 %.
vec3 tone_aces(vec3 color) {
    const float kExposure = 1.4619;
    const mat3 kInput = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    const mat3 kOutput = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    vec3 v = kInput * (kExposure * color);
    vec3 a = v * (v + 0.0245786) - 0.000090537;
    vec3 b = v * (0.983729 * v + 0.4329510) + 0.238081;
    return kOutput * (a / b);
}

// Luminance compressed to 0 .. 1, nearly linear in the darks (hdr.compress). `inverse_white` is 1 over the luminance that
// maps to 1; 0 = infinite white. Reinhard et al. 2002.
float compress(float scaled, float inverse_white) {
    return scaled * (1.0 + scaled * inverse_white * inverse_white) / (1.0 + scaled);
}

// Rescales the color from one luminance to another; black stays black.
vec3 with_luminance(vec3 color, float from, float to) {
    return from > 0.0 ? color * (to / from) : vec3(0.0);
}

// ln(1 + x), x >= 0, also accurate for small x.
vec3 log1p(vec3 x) {
    return mix(log(1.0 + x), x * (1.0 - x * (0.5 - x / 3.0)), lessThan(x, vec3(0.01)));
}

// A knee for each channel: linear in the darks, logarithmic in the brights; contrast 0 is the identity
// (hdr.tonemap-shader).
vec3 knee(vec3 color, float contrast) {
    return contrast < 1e-4 ? color : log1p(contrast * color) / contrast;
}

// Linear to the encoding of a display of this gamma (hdr.gamma).
vec3 power_encode(vec3 linear, float gamma) {
    return pow(max(linear, vec3(0.0)), vec3(1.0 / gamma));
}

// Linear [0, 1] to sRGB [0, 1] (IEC 61966-2-1).
vec3 srgb_encode(vec3 linear) {
    vec3 power = 1.055 * pow(max(linear, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    return mix(power, 12.92 * linear, lessThan(linear, vec3(0.0031308)));
}

// Linear [0, 1] for a display of this gamma, or, 0, of sRGB. One power for both: a software OpenGL executes both sides of
// a condition.
vec3 display_encode(vec3 linear, float gamma) {
    bool is_srgb = gamma <= 0.0;
    float least = is_srgb ? 0.0031308 : 0.0;
    vec3 power = pow(max(linear, vec3(least)), vec3(1.0 / (is_srgb ? 2.4 : gamma)));
    vec3 encoded = mix(1.055 * power - 0.055, 12.92 * linear, lessThan(linear, vec3(least)));
    return is_srgb ? encoded : power;
}

// The inverse of srgb_encode().
vec3 srgb_to_linear(vec3 encoded) {
    return mix(
        pow((encoded + 0.055) / 1.055, vec3(2.4)), encoded / 12.92, lessThanEqual(encoded, vec3(0.04045)));
}

// Triangular noise in (-1, 1): added in units of one code before rounding, it makes the rounding error
// independent of the color and so removes banding.
float triangular_dither(vec2 pixel) {
    return pixel_noise(pixel) + pixel_noise(pixel.yx + 47.0) - 1.0;
}
