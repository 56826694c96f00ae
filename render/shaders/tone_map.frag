// Scene radiance to display codes: haze, exposure, curve, encoding, dither.
//   TONE_CURVE  as numbered by ToneCurve
// Techniques: hdr.compress, hdr.defog, hdr.dodge-burn, hdr.tonemap-shader
#version 450
#include "lib/tone.glsl"
#include "tone_gpu.h"
#include "fullscreen_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D scene_radiance;
layout(std140, binding = kToneMeasureBinding) uniform Measure {
    ImageStatistics measure;
};

uniform float exposure;       // 2^ev
uniform float defog;          // fraction of the mean color to subtract
uniform float inverse_white;  // Reinhard: 1 / luminance shown as 1
uniform float contrast;       // Knee
uniform float gamma;          // Knee, or instead of sRGB; 0 = sRGB
uniform float dither_codes;   // amplitude

const float kMaxExposed = 1e6;     // white with any curve, and far from overflow
const float kKneeScale = 0.3333;   // of codes: linear 1 lies some 3.5 stops below white, as in exrdisplay

layout(location = 0) out vec4 display;

#if TONE_CURVE == 4
layout(binding = kLocalFineUnit) uniform sampler2D local_fine;      // luminance blurred with scales 0 .. 3
layout(binding = kLocalMediumUnit) uniform sampler2D local_medium;  // 4 .. 7
layout(binding = kLocalCoarseUnit) uniform sampler2D local_coarse;  // 8, 9

uniform float key;

const int kScales = 9;
const float kScaleRatio = 1.6;
const float kSharpness = 256.0;  // 2^phi with phi = 8
const float kEven = 0.05;        // maximum activity of an even region; more makes halos

// Mean luminance, after exposure, of the largest region around the pixel with even light, up to the first scale whose
// two Gaussians differ. Reinhard et al. 2002 (hdr.dodge-burn).
float even_surround(vec2 pixel, float scale) {
    vec2 uv = pixel / vec2(textureSize(scene_radiance, 0));
    vec4 fine = texelFetch(local_fine, ivec2(pixel), 0);
    vec4 medium = texture(local_medium, uv);
    vec2 coarse = texture(local_coarse, uv).rg;
    float v[10] = float[](
        fine.x, fine.y, fine.z, fine.w, medium.x, medium.y, medium.z, medium.w, coarse.x, coarse.y);
    float surround = v[0];
    float floor_of_activity = kSharpness * key / scale;  // divided by the square of the scale
    for (int i = 0; i < kScales; ++i) {
        if (abs(v[i] - v[i + 1]) >= kEven * (floor_of_activity + v[i])) {
            break;
        }
        surround = v[i];
        floor_of_activity /= kScaleRatio * kScaleRatio;
    }
    return surround * scale;
}
#endif

void main() {
    vec3 light = sanitize_light(texelFetch(scene_radiance, ivec2(gl_FragCoord.xy), 0).rgb, 1e30);
    float scale = exposure * measure.mean_scale.w;
    vec3 color = min(max(light - defog * measure.mean_scale.rgb, 0.0) * scale, kMaxExposed);
#if TONE_CURVE == 0
    color = tone_neutral(color);
#elif TONE_CURVE == 1
    color = tone_aces(color);
#elif TONE_CURVE == 3
    float scaled = luminance(color);
    color = with_luminance(color, scaled, compress(scaled, inverse_white));
#elif TONE_CURVE == 4
    float scaled = luminance(color);
    color = with_luminance(color, scaled, scaled / (1.0 + even_surround(gl_FragCoord.xy, scale)));
#elif TONE_CURVE == 5
    color = knee(color, contrast);
#endif
#if TONE_CURVE == 5
    color = clamp(kKneeScale * power_encode(color, gamma), 0.0, 1.0);
#else
    color = display_encode(clamp(color, 0.0, 1.0), gamma);
#endif
    display = vec4(color + dither_codes * triangular_dither(gl_FragCoord.xy) / 255.0, 1.0);
}
