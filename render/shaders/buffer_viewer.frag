// Displays any 2D texture of the frame: a range of values becomes black to white, one channel or
// three. NaN is magenta, infinity cyan. The target has the texture's size.
#version 450
#include "lib/numbers.glsl"
#include "fullscreen_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D buffer_image;
uniform vec2 shown_range;    // the values shown as black and white
uniform int shown_channel;   // 0 .. 3: this one in gray; 4: red, green and blue
uniform int encode_srgb;     // 1: the values are linear light

layout(location = 0) out vec4 color;

const vec3 kNotANumber = vec3(1.0, 0.0, 1.0);
const vec3 kInfinite = vec3(0.0, 1.0, 1.0);

vec3 srgb_from_linear(vec3 linear) {
    vec3 low = linear * 12.92;
    vec3 high = 1.055 * pow(max(linear, 0.0), vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, lessThanEqual(linear, vec3(0.0031308)));
}

void main() {
    vec4 texel = texelFetch(buffer_image, ivec2(gl_FragCoord.xy), 0);
    vec3 value = shown_channel < 4 ? vec3(texel[shown_channel]) : texel.rgb;
    vec3 shown = clamp((value - shown_range.x) / (shown_range.y - shown_range.x), 0.0, 1.0);
    shown = encode_srgb != 0 ? srgb_from_linear(shown) : shown;
    if (any(is_infinite(value.rgb))) {
        shown = kInfinite;
    }
    if (any(is_nan(value))) {
        shown = kNotANumber;
    }
    color = vec4(shown, 1.0);
}
