// One step of an image from its previous state, or the first state (texture_feedback_pass.h). Both images repeat.
// Techniques: tex.feedback
#version 450
#include "texture_feedback_gpu.h"

layout(local_size_x = kFeedbackGroup, local_size_y = kFeedbackGroup) in;

layout(binding = kFeedbackStartUnit) uniform sampler2D start;
layout(binding = kFeedbackFromImage, rgba32f) readonly uniform image2D from;
layout(binding = kFeedbackToImage, rgba32f) writeonly uniform image2D to;

uniform int rule;
uniform int next_rule;  // with kFeedbackStart: that of the steps
uniform float amount;
uniform vec2 feed_kill;

vec4 state_at(ivec2 texel, ivec2 size) {
    return imageLoad(from, (texel + size) % size);
}

// Of a reaction: the first substance everywhere, some of the second where the image is bright.
vec4 first_state(ivec2 texel, ivec2 size) {
    vec4 color = textureLod(start, (vec2(texel) + 0.5) / vec2(size), 0.0);
    float live = step(0.5, color.r);
    return next_rule == kFeedbackReaction ? vec4(1.0 - 0.5 * live, 0.25 * live, 0.0, 1.0) : color;
}

vec4 life(ivec2 texel, ivec2 size) {
    float neighbors = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            neighbors += x == 0 && y == 0 ? 0.0 : step(0.5, state_at(texel + ivec2(x, y), size).r);
        }
    }
    bool lives = neighbors == 3.0 || (neighbors == 2.0 && state_at(texel, size).r > 0.5);
    return vec4(vec3(lives ? 1.0 : 0.0), 1.0);
}

// Gray and Scott as in Pearson, "Complex Patterns in a Simple System", 1993: x the first substance, y the second.
vec4 reaction(ivec2 texel, ivec2 size) {
    vec2 here = state_at(texel, size).xy;
    vec2 sides = vec2(0.0);
    vec2 corners = vec2(0.0);
    for (int i = -1; i <= 1; i += 2) {
        sides += state_at(texel + ivec2(i, 0), size).xy + state_at(texel + ivec2(0, i), size).xy;
        corners += state_at(texel + ivec2(i, i), size).xy + state_at(texel + ivec2(i, -i), size).xy;
    }
    vec2 diffused = vec2(1.0, 0.5) * (0.2 * sides + 0.05 * corners - here);
    float reacted = here.x * here.y * here.y;
    vec2 change = vec2(feed_kill.x * (1.0 - here.x) - reacted, reacted - (feed_kill.x + feed_kill.y) * here.y);
    return vec4(clamp(here + diffused + change, 0.0, 1.0), 0.0, 1.0);
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(to);
    if (any(greaterThanEqual(texel, size))) {
        return;
    }
    vec4 state = vec4(0.0);
    if (rule == kFeedbackStart) {
        state = first_state(texel, size);
    } else if (rule == kFeedbackLife) {
        state = life(texel, size);
    } else if (rule == kFeedbackReaction) {
        state = reaction(texel, size);
    } else {
        state = state_at(texel, size) + vec4(vec3(amount), 0.0);
    }
    imageStore(to, texel, state);
}
