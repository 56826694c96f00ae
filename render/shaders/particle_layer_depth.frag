// Of each four pixels the nearest depth and the farthest, in turn (render/particle_layer.h).
#version 450

layout(binding = 4) uniform sampler2D scene_depth;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(scene_depth, 0) - 1;
    float nearest = 0.0;
    float farthest = 1.0;
    for (int i = 0; i < 4; ++i) {
        float depth = texelFetch(scene_depth, min(2 * at + ivec2(i & 1, i >> 1), last), 0).r;
        nearest = max(nearest, depth);
        farthest = min(farthest, depth);
    }
    gl_FragDepth = ((at.x + at.y) & 1) == 0 ? nearest : farthest;
}
