// Scene radiance to display codes: exposure, curve, sRGB, dither.
//   TONE_CURVE  as numbered by ToneCurve
#version 450
#include "lib/tone.glsl"

layout(binding = 0) uniform sampler2D scene_radiance;

uniform float exposure;  // 2^ev

const float kMaxExposed = 1e6;  // white by any curve, and far from overflow

layout(location = 0) out vec4 display;

void main() {
    vec3 color = max(texelFetch(scene_radiance, ivec2(gl_FragCoord.xy), 0).rgb, vec3(0.0)) * exposure;
    color = min(color, vec3(kMaxExposed));
#if TONE_CURVE == 0
    color = tone_neutral(color);
#elif TONE_CURVE == 1
    color = tone_aces(color);
#endif
    color = srgb_encode(clamp(color, 0.0, 1.0));
    display = vec4(color + triangular_dither(gl_FragCoord.xy) / 255.0, 1.0);
}
