// Drops on the lens. Each is a small lens that shows the image inverted; some run down and leave beads.
// Everything by eye.
#version 450
#include "lib/noise.glsl"
#include "lib/view.glsl"

uniform float amount;
uniform float size;  // of a cell [image heights]
uniform float speed;
uniform float strength;
uniform uint seed;
uniform float time;

layout(location = 0) out vec4 shift;  // [px]; alpha: maximum depth to read

// Shift by a round drop at `from_center` [radii]: 0 outside, inverts the image inside.
vec2 refract_drop(vec2 from_center, float radius) {
    float inside = 1.0 - min(dot(from_center, from_center), 1.0);
    return -4.0 * strength * radius * from_center * inside * (2.0 - inside);
}

vec4 random_of(ivec2 cell, uint salt) {
    return unpackUnorm4x8(lattice_hash(cell.x, cell.y, seed + salt));
}

// Drops that stay where they fell, until they dry up.
vec2 resting_drops(vec2 at, float cell_size, uint salt) {
    ivec2 cell = ivec2(floor(at / cell_size));
    vec4 random = random_of(cell, salt);
    float life = time * mix(0.05, 0.2, random.x) + random.y;
    // A new position for each life.
    vec4 now = random_of(cell, salt + 1u + uint(life));
    bool wet = now.x < amount;
    float age = fract(life);
    float radius = cell_size * mix(0.1, 0.32, now.y) * smoothstep(0.0, 0.02, age) * (1.0 - age * age);
    vec2 center = (vec2(cell) + 0.34 + 0.32 * now.zw) * cell_size;
    return wet ? refract_drop((at - center) / max(radius, 1e-6), radius) : vec2(0.0);
}

// A column down which drops run one after another at varying speed, with beads in their wake.
vec2 running_drop(vec2 at, float width, uint salt) {
    int column = int(floor(at.x / width));
    vec4 random = random_of(ivec2(column, 0), salt);
    float run = time * speed * mix(0.4, 1.0, random.x) + random.y;
    float progress = fract(run);
    float halting = progress - 0.9 * sin(progress * 37.7) / 37.7;  // 2 pi 6: six stops
    float head = 1.2 - 1.5 * halting;

    vec4 now = random_of(ivec2(column, int(run)), salt + 1u);
    bool wet = now.x < amount;
    float radius = width * mix(0.16, 0.24, now.y);
    float center = (float(column) + mix(0.35, 0.65, now.z)) * width;
    float wobble = 0.08 * width * sin(23.0 * at.y + 6.0 * now.w);
    vec2 from_head = vec2(at.x - center - wobble, (at.y - head) * (at.y > head ? 0.55 : 1.0));
    vec2 moved = refract_drop(from_head / radius, radius);

    float row_height = 0.35 * width;
    float row = (floor(at.y / row_height) + 0.5) * row_height;
    float behind = row - head - 1.5 * radius;
    float left = 0.5 * radius * (1.0 - smoothstep(0.0, 0.45, behind)) * step(0.0, behind);
    vec2 from_bead = vec2(at.x - center - wobble, at.y - row);
    moved += left > 0.0 ? refract_drop(from_bead / left, left) : vec2(0.0);
    return wet ? moved : vec2(0.0);
}

void main() {
    vec2 at = gl_FragCoord.xy * view.size.w;  // [image heights]
    vec2 moved = running_drop(at, 2.0 * size, 100u);
    moved = moved == vec2(0.0) ? resting_drops(at, size, 200u) : moved;
    moved = moved == vec2(0.0) ? resting_drops(at + 0.37, 0.4 * size, 300u) : moved;
    shift = vec4(moved * view.size.y, 0.0, 1.0);
}
