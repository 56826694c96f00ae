// Of each four pixels the depth in their middle where they are of one surface, else the nearest and the farthest, in turn
// (render/particle_layer.h).
#version 450

layout(binding = 4) uniform sampler2D scene_depth;

float depth_at(ivec2 at) {
    return texelFetch(scene_depth, clamp(at, ivec2(0), textureSize(scene_depth, 0) - 1), 0).r;
}

// Whether it changes from b to c about as much as before and after: depths are near / distance, linear in the image on
// planes.
bool is_smooth(float a, float b, float c, float d) {
    return abs(c - b) <= 2.0 * min(abs(b - a), abs(d - c)) + 0.01 * min(b, c);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 first = 2 * at;
    float four[4];
    for (int i = 0; i < 4; ++i) {
        four[i] = depth_at(first + ivec2(i & 1, i >> 1));
    }
    bool smooth_rows = is_smooth(depth_at(first - ivec2(1, 0)), four[0], four[1], depth_at(first + ivec2(2, 0)))
        && is_smooth(depth_at(first + ivec2(-1, 1)), four[2], four[3], depth_at(first + ivec2(2, 1)));
    bool smooth_columns = is_smooth(depth_at(first - ivec2(0, 1)), four[0], four[2], depth_at(first + ivec2(0, 2)))
        && is_smooth(depth_at(first + ivec2(1, -1)), four[1], four[3], depth_at(first + ivec2(1, 2)));
    float nearest = max(max(four[0], four[1]), max(four[2], four[3]));
    float farthest = min(min(four[0], four[1]), min(four[2], four[3]));
    gl_FragDepth = smooth_rows && smooth_columns ? 0.25 * (four[0] + four[1] + four[2] + four[3])
                   : ((at.x + at.y) & 1) == 0    ? nearest
                                                 : farthest;
}
