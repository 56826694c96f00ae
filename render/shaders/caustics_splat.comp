// Sums the light of a map: an invocation a cell of the grid of rays, which is cut into so many that they lie half a
// texel from each other or less where they land; each gives its light to the nearest four texels. None is lost, however
// the water folds, and whole numbers add up to the same in any order.
#version 450
#include "lib/caustic_record.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer Rays {
    vec4 rays[];
};
layout(std430, binding = 1) buffer Light {
    uint light[];
};
uniform uint stride;  // rays from map to map

const float kMost = 48.0;       // rays along a side of a cell
const float kPerTexel = 2.0;    // rays along a texel
const float kMethodPool = 1.0;  // CausticMethod

void add(uint first, ivec2 texel, int side, float amount) {
    if (texel.x >= 0 && texel.y >= 0 && texel.x < side && texel.y < side) {
        atomicAdd(light[first + uint(texel.y * side + texel.x)], uint(amount + 0.5));
    }
}

void main() {
    uint map = gl_GlobalInvocationID.y;
    CausticRecord record = caustic_record(map);
    uint cells = uint(record.grid.x);
    uint cell = gl_GlobalInvocationID.x;
    if (cell >= cells * cells) {
        return;
    }
    int side = int(record.grid.y);
    uint corner = map * stride + (cell / cells) * (cells + 1u) + cell % cells;
    vec4 a = rays[corner];
    vec4 b = rays[corner + 1u];
    vec4 c = rays[corner + cells + 1u];
    vec4 d = rays[corner + cells + 2u];

    vec2 longest = max(max(abs(b.xy - a.xy), abs(d.xy - c.xy)), max(abs(c.xy - a.xy), abs(d.xy - b.xy)));
    int rows = int(clamp(ceil(kPerTexel * max(longest.x, longest.y) - 0.01), 1.0, kMost));
    float part = 1.0 / float(rows);
    float texels = record.grid.y / record.grid.x;
    float area = texels * texels;
    if (record.grid.w == kMethodPool) {
        vec2 across = d.xy - a.xy;
        vec2 along = c.xy - b.xy;
        area = 0.5 * abs(across.x * along.y - across.y * along.x);
    }
    float whole = kWhole * area * part * part;
    uint first = map * uint(side * side);
    for (int j = 0; j < rows; ++j) {
        float v = (float(j) + 0.5) * part;
        vec3 left = mix(a.xyz, c.xyz, v);
        vec3 right = mix(b.xyz, d.xyz, v);
        for (int i = 0; i < rows; ++i) {
            vec3 ray = mix(left, right, (float(i) + 0.5) * part);
            vec2 at = clamp(ray.xy, vec2(-8.0), vec2(float(side) + 8.0)) - 0.5;
            ivec2 texel = ivec2(floor(at));
            vec2 share = at - vec2(texel);
            float amount = whole * ray.z;
            add(first, texel, side, amount * (1.0 - share.x) * (1.0 - share.y));
            add(first, texel + ivec2(1, 0), side, amount * share.x * (1.0 - share.y));
            add(first, texel + ivec2(0, 1), side, amount * (1.0 - share.x) * share.y);
            add(first, texel + ivec2(1, 1), side, amount * share.x * share.y);
        }
    }
}
