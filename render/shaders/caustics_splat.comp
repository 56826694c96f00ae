// Accumulates the light of a map: one invocation per cell of the ray grid, which is subdivided until its rays land at
// most half a texel apart, or a whole one above the water; each splats its light to the nearest four texels. Energy is
// conserved even where light folds over itself, and integer sums do not depend on the order.
// Techniques: caustic.projected-vertices
#version 450
#include "lib/caustic_record.glsl"
#include "caustics_gpu.h"

layout(local_size_x = 64) in;

layout(std430, binding = kCausticRaysBinding) readonly buffer Rays {
    vec4 rays[];
};
layout(std430, binding = kCausticLightBinding) buffer Light {
    uint light[];
};
uniform int width;  // of the atlas [texels]

const float kMaxRays = 48.0;          // rays along a side of a cell
const float kPerTexel = 2.0;          // rays along a texel
const float kMaxRaysMirrored = 12.0;  // waves spread reflected light so far that many cells overlap
const float kMirroredPerTexel = 1.0;
const float kWireLight = 4.0;         // of wires, relative to that under flat water

int rays_along(vec2 one, vec2 other, bool mirrored) {
    vec2 longest = max(abs(one), abs(other));
    float wanted = (mirrored ? kMirroredPerTexel : kPerTexel) * max(longest.x, longest.y);
    return int(clamp(ceil(wanted - 0.01), 1.0, mirrored ? kMaxRaysMirrored : kMaxRays));
}

void add(ivec2 first, ivec2 texel, int side, float amount) {
    if (texel.x >= 0 && texel.y >= 0 && texel.x < side && texel.y < side) {
        atomicAdd(light[(first.y + texel.y) * width + first.x + texel.x], uint(amount + 0.5));
    }
}

// To the nearest four texels.
void splat(ivec2 first, int side, vec2 position, float amount) {
    vec2 at = clamp(position, vec2(-8.0), vec2(float(side) + 8.0)) - 0.5;
    ivec2 texel = ivec2(floor(at));
    vec2 weight = at - vec2(texel);
    add(first, texel, side, amount * (1.0 - weight.x) * (1.0 - weight.y));
    add(first, texel + ivec2(1, 0), side, amount * weight.x * (1.0 - weight.y));
    add(first, texel + ivec2(0, 1), side, amount * (1.0 - weight.x) * weight.y);
    add(first, texel + ivec2(1, 1), side, amount * weight.x * weight.y);
}

// A line about a texel wide.
void add_wire(ivec2 first, int side, vec2 a, vec2 b) {
    float length_ = distance(a, b);
    int points = int(clamp(ceil(kPerTexel * length_), 1.0, kMaxRays));
    for (int i = 0; i < points; ++i) {
        float amount = kFixedPointOne * kWireLight * min(length_, kMaxRays) / float(points);
        splat(first, side, mix(a, b, (float(i) + 0.5) / float(points)), amount);
    }
}

void main() {
    ivec2 ray_of_map = caustic_ray();
    CausticRecord record = caustic_record(ray_of_map.x);
    int cells = int(record.grid.x);
    ivec2 cell = ivec2(ray_of_map.y % (cells + 1), ray_of_map.y / (cells + 1));
    if (cell.x >= cells || cell.y >= cells) {
        return;
    }
    int side = int(record.grid.y);
    int corner = int(record.target.z) + ray_of_map.y;
    vec4 a = rays[corner];
    vec4 b = rays[corner + 1];
    vec4 c = rays[corner + cells + 1];
    vec4 d = rays[corner + cells + 2];

    bool mirrored = record.grid.w == kCausticsMirrored;
    int columns = rays_along(b.xy - a.xy, d.xy - c.xy, mirrored);
    int rows = rays_along(c.xy - a.xy, d.xy - b.xy, mirrored);
    float texels = record.grid.y / record.grid.x;
    float area = texels * texels;
    if (record.grid.w == kCausticsPool) {
        vec2 across = d.xy - a.xy;
        vec2 along = c.xy - b.xy;
        area = 0.5 * abs(across.x * along.y - across.y * along.x);
    }
    float whole = kFixedPointOne * area / float(rows * columns);
    ivec2 first = ivec2(record.target.xy);
    for (int j = 0; j < rows; ++j) {
        float v = (float(j) + 0.5) / float(rows);
        vec3 left = mix(a.xyz, c.xyz, v);
        vec3 right = mix(b.xyz, d.xyz, v);
        for (int i = 0; i < columns; ++i) {
            vec3 ray = mix(left, right, (float(i) + 0.5) / float(columns));
            splat(first, side, ray.xy, whole * ray.z);
        }
    }
    int wires = int(record.wires.x);
    if (wires > 0 && cell.y % wires == 0 && a.z > 0.0 && b.z > 0.0) {
        add_wire(first, side, a.xy, b.xy);
    }
    if (wires > 0 && cell.x % wires == 0 && a.z > 0.0 && c.z > 0.0) {
        add_wire(first, side, a.xy, c.xy);
    }
}
