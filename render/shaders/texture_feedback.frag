// Draws the state of a TextureFeedback into its target.
// Techniques: tex.feedback
#version 450
#include "lib/tone.glsl"
#include "texture_feedback_gpu.h"

layout(binding = kFeedbackStateUnit) uniform sampler2D state;

uniform int rule;
uniform vec3 low;
uniform vec3 high;
uniform bool encoded;  // the target is sRGB

layout(location = 0) out vec4 color;

void main() {
    vec4 here = texelFetch(state, ivec2(gl_FragCoord.xy), 0);
    float much = rule == kFeedbackReaction ? smoothstep(0.1, 0.3, here.y) : step(0.5, here.r);
    vec3 drawn = rule == kFeedbackAdd ? here.rgb : mix(low, high, much);
    color = vec4(encoded ? srgb_encode(clamp(drawn, 0.0, 1.0)) : drawn, 1.0);
}
