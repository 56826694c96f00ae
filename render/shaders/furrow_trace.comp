// Grows the furrows of one field per work group, one after another, bit-identical to content/bake/furrow_trace.cpp:
// the 64 invocations divide the pixels along and around a segment, and search for the next start together. Stops after
// `budget` segments, and the next dispatch continues: software OpenGL aborts a shader after 65,535 loop iterations.
// Techniques: wrinkle.furrow.trace
#version 450
#include "lib/furrow.glsl"
#include "lib/philox.glsl"
#include "lib/repeatable.glsl"
#include "furrow_gpu.h"

const uint kThreads = 64u;
layout(local_size_x = 64) in;

layout(std430, binding = kFurrowTrianglesBinding) readonly buffer Triangles {
    float triangles[];  // FurrowTriangle, tightly packed
};
layout(std430, binding = kFurrowCoverBinding) readonly buffer Cover {
    int cover[];
};
layout(std430, binding = kFurrowCellsBinding) coherent buffer Cells {
    uint cells[];  // of field 0, then of field 1
};
layout(std430, binding = kFurrowHeightsBinding) coherent buffer Heights {
    uint heights[];  // bits of floats that are not negative
};
// Progress of a field.
struct Progress {
    uint next;      // start to try: triangles, then pixels
    uint furrow;    // that grows, or 0
    uint backward;  // its half
    uint segment;
    float x;  // beginning of the segment [px]
    float y;
    int left;  // segments
    int unused;
};
layout(std430, binding = kFurrowProgressBinding) buffer ProgressOfFields {
    Progress progress[2];
};

uniform int triangle_count;
uniform int budget;
uniform vec4 angle_length;   // FurrowFunctions: value at 0 and increase
uniform vec4 density_limit;
uniform vec2 width_depth;
uniform float scale;
uniform int literal_turn;
uniform uint first_key_x, first_key_y, second_key_x, second_key_y;  // of the random numbers of both fields

const uint kBand = 0x80000000u;
const int kTriangleFloats = 27;
const float kStill = 1e-4;
const float kFar = 1e30;
const float kMinStep = 0.5;
const float kMaxTurn = 1.2;

shared uint first_hit;
shared uint found_start;

uint field;
int pixels;

vec2 triangle_vec2(int triangle, int at) {
    int i = kTriangleFloats * triangle + at;
    return vec2(triangles[i], triangles[i + 1]);
}

ivec2 cell_of(vec2 p) {
    ivec2 cell = ivec2(p);
    return cell - ivec2(greaterThan(vec2(cell), p));
}

bool is_obstacle(ivec2 at, uint furrow) {
    int index = pixel_index(at);
    if (index < 0 || cover[index] < 0) {
        return true;
    }
    uint owner = cells[int(field) * pixels + index] & ~kBand;
    return owner != 0u && owner != furrow;
}

void own(ivec2 at, uint furrow) {
    int index = pixel_index(at);
    if (index >= 0) {
        int cell = int(field) * pixels + index;
        uint old = atomicOr(cells[cell], 0u);
        if ((old & ~kBand) == 0u) {
            atomicOr(cells[cell], furrow | kBand);
        }
    }
}

vec2 field_at(int triangle, vec2 p) {
    precise vec2 offset = p - triangle_vec2(triangle, 0);
    vec2 value = triangle_vec2(triangle, 6 + 2 * int(field));
    vec2 right = triangle_vec2(triangle, 10 + 2 * int(field));
    vec2 down = triangle_vec2(triangle, 14 + 2 * int(field));
    precise vec2 d = value + (right * offset.x + down * offset.y);
    return d;
}

float line_at(vec2 coefficients, float x) {
    precise float value = coefficients.x + coefficients.y * x;
    return value;
}

struct FurrowShape {
    float angle;
    float length_px;
    float density;
    float width;
    float depth;
    int limit;
};

FurrowShape furrow_shape(float magnitude) {
    float x = clamp(magnitude, 0.0, 2.0);
    float limit = line_at(density_limit.zw, x);
    precise float density = scale * line_at(density_limit.xy, x);
    precise float length_px = scale * line_at(angle_length.zw, x);
    precise float width = scale * (width_depth.x * x);
    precise float depth = width_depth.y * (x * x);
    return FurrowShape(
        clamp(line_at(angle_length.xy, x), -kMaxTurn, kMaxTurn), max(length_px, kMinStep), max(density, 0.0), width, depth, limit > 0.0 ? int(limit) : 0);
}

// Distance along a segment to the first pixel border across an axis, and between borders.
vec2 crossings(float at, int cell, float direction) {
    if (abs(direction) < 1e-6) {
        return vec2(kFar);
    }
    float inverse = repeatable_reciprocal(direction);
    precise float edge = float(direction > 0.0 ? cell + 1 : cell) - at;
    precise float first = edge * inverse;
    return vec2(first, abs(inverse));
}

float crossing(vec2 across, int i) {
    precise float at = across.x + float(i) * across.y;
    return at;
}

// Number of borders across one axis before the distance `t`, or with `equal` up to it.
int lines_before(vec2 across, float t, bool equal) {
    int count = max(int((t - across.x) / across.y), 0);
    while (count > 0 && !(equal ? crossing(across, count - 1) <= t : crossing(across, count - 1) < t)) {
        --count;
    }
    while (equal ? crossing(across, count) <= t : crossing(across, count) < t) {
        ++count;
    }
    return count;
}

float line_coverage(float distance, float width) {
    precise float half_width = 0.5 * width;
    precise float overlap = min(distance + 0.5, half_width) - max(distance - 0.5, -half_width);
    return clamp(overlap, 0.0, 1.0);
}

// Claims the pixels along a segment up to the first obstacle; returns its length.
float walk(vec2 from, vec2 direction, float length_px, uint furrow, out bool met) {
    ivec2 start = cell_of(from);
    ivec2 side = ivec2(direction.x > 0.0 ? 1 : -1, direction.y > 0.0 ? 1 : -1);
    vec2 across[2] = vec2[2](
        crossings(from.x, start.x, direction.x), crossings(from.y, start.y, direction.y));
    if (gl_LocalInvocationIndex == 0u) {
        first_hit = floatBitsToUint(length_px);
    }
    barrier();
    for (int phase = 0; phase < 2; ++phase) {
        float hit = uintBitsToFloat(first_hit);
        for (int axis = 0; axis < 2; ++axis) {
            for (int i = int(gl_LocalInvocationIndex);; i += int(kThreads)) {
                float t = crossing(across[axis], i);
                if (!(t < length_px)) {
                    break;
                }
                int other = lines_before(across[1 - axis], t, axis == 1);
                ivec2 steps = axis == 0 ? ivec2(i + 1, other) : ivec2(other, i + 1);
                ivec2 cell = start + side * steps;
                t = t > 0.0 ? t : 0.0;
                bool obstacle = is_obstacle(cell, furrow);
                if (phase == 0 && obstacle) {
                    atomicMin(first_hit, floatBitsToUint(t));
                }
                if (phase == 1 && !obstacle && (t < hit || (t == hit && axis == 0))) {
                    own(cell, furrow);
                }
            }
        }
        memoryBarrierShared();
        barrier();
    }
    if (gl_LocalInvocationIndex == 0u) {
        own(start, furrow);
    }
    float hit = uintBitsToFloat(first_hit);
    met = hit < length_px;
    return hit;
}

void draw(vec2 from, vec2 direction, float length_px, FurrowShape shape, uint furrow) {
    precise float band = 0.5 * shape.density;
    precise float line = 0.5 * shape.width + 0.5;
    precise float owned = max(0.5 * shape.width, 0.5);
    float reach = max(max(band, line), owned);
    precise float reach2 = reach * reach;
    precise float band2 = band * band;
    precise float line2 = line * line;
    precise float owned2 = owned * owned;
    precise vec2 to = from + direction * length_px;
    precise vec2 lowest = min(from, to) - reach;
    precise vec2 highest = max(from, to) + reach;
    ivec2 low = cell_of(lowest);
    ivec2 extent = cell_of(highest) - low + 1;
    for (int i = int(gl_LocalInvocationIndex); i < extent.x * extent.y; i += int(kThreads)) {
        ivec2 at = low + ivec2(i % extent.x, i / extent.x);
        precise vec2 offset = vec2(at) + 0.5 - from;
        precise float ahead = offset.x * direction.x + offset.y * direction.y;
        float along = clamp(ahead, 0.0, length_px);
        precise vec2 away = offset - direction * along;
        precise float distance2 = away.x * away.x + away.y * away.y;
        int index = pixel_index(at);
        if (distance2 > reach2 || index < 0) {
            continue;
        }
        int cell = int(field) * pixels + index;
        if (distance2 <= band2) {
            atomicOr(cells[cell], kBand);
        }
        if (distance2 <= owned2) {
            own(at, furrow);
        }
        if (distance2 < line2 && cover[index] >= 0) {
            precise float distance = distance2 > 1e-12 ? distance2 * repeatable_inverse_root(distance2) : 0.0;
            precise float height = 1.0 - shape.depth * line_coverage(distance, shape.width);
            atomicMin(heights[cell], floatBitsToUint(height > 0.0 ? height : 0.0));
        }
    }
}

vec2 within(vec2 p) {
    for (int c = 0; c < 2; ++c) {
        float period = float(size[c]);
        if (wraps[c] != 0) {
            p[c] += p[c] < 0.0 ? period : p[c] >= period ? -period : 0.0;
        }
    }
    return p;
}

// Draws the next segment; false if the half of the furrow ends.
bool grow(inout Progress now) {
    vec2 p = vec2(now.x, now.y);
    ivec2 cell = cell_of(p);
    if (is_obstacle(cell, now.furrow)) {
        return false;
    }
    int index = pixel_index(cell);
    if (gl_LocalInvocationIndex == 0u) {
        atomicOr(cells[int(field) * pixels + index], kBand);
    }
    vec2 d = field_at(cover[index], p);
    precise float size2 = d.x * d.x + d.y * d.y;
    precise float still2 = kStill * kStill;
    if (!(size2 > still2)) {
        return false;
    }
    float inverse = repeatable_inverse_root(size2);
    precise float magnitude = size2 * inverse;
    precise vec2 along = now.backward != 0u ? -(d * inverse) : d * inverse;
    FurrowShape shape = furrow_shape(magnitude);
    float turn = 1.0;
    if (literal_turn == 0) {
        uvec2 key = field == 0u ? uvec2(first_key_x, first_key_y) : uvec2(second_key_x, second_key_y);
        turn = 2.0 * unit_float(philox(uvec4(0u, now.segment * 2u + now.backward, now.furrow, 0u), key).x) - 1.0;
    }
    precise float angle = shape.angle * turn;
    vec2 rotation = repeatable_cos_sin(angle);
    precise vec2 direction = vec2(
        along.x * rotation.x - along.y * rotation.y, along.x * rotation.y + along.y * rotation.x);
    bool met;
    float length_px = walk(p, direction, shape.length_px, now.furrow, met);
    draw(p, direction, length_px, shape, now.furrow);
    if (met || now.left <= 0) {
        return false;
    }
    now.left = min(now.left, shape.limit) - 1;
    precise vec2 q = p + direction * length_px;
    vec2 next = within(q);
    now.x = next.x;
    now.y = next.y;
    ++now.segment;
    return true;
}

vec2 start_place(uint start) {
    if (start >= uint(triangle_count)) {
        int pixel = int(start) - triangle_count;
        return vec2(pixel % size.x, pixel / size.x) + 0.5;
    }
    int triangle = int(start);
    precise vec2 middle = (triangle_vec2(triangle, 0) + triangle_vec2(triangle, 2) + triangle_vec2(triangle, 4)) * (1.0 / 3.0);
    return within(middle);
}

bool may_start(uint start) {
    vec2 p = start_place(start);
    if (any(lessThan(p, vec2(0.0))) || any(greaterThanEqual(p, vec2(size)))) {
        return false;
    }
    int index = pixel_index(cell_of(p));
    return index >= 0 && cover[index] >= 0 && (cells[int(field) * pixels + index] & kBand) == 0u;
}

void begin_half(inout Progress now, bool backward) {
    vec2 place = start_place(now.furrow - 1u);
    now.backward = backward ? 1u : 0u;
    now.segment = 0u;
    now.x = place.x;
    now.y = place.y;
    now.left = 0x7fffffff;
}

void main() {
    field = gl_WorkGroupID.x;
    pixels = size.x * size.y;
    uint starts = uint(triangle_count + pixels);
    Progress now = progress[field];
    for (int step = 0; step < budget && (now.furrow != 0u || now.next < starts); ++step) {
        memoryBarrierBuffer();
        barrier();
        if (now.furrow != 0u) {
            if (!grow(now)) {
                if (now.backward == 0u) {
                    begin_half(now, true);
                } else {
                    now.furrow = 0u;
                }
            }
            continue;
        }
        if (gl_LocalInvocationIndex == 0u) {
            found_start = starts;
        }
        barrier();
        uint own_start = now.next + gl_LocalInvocationIndex;
        if (own_start < starts && may_start(own_start)) {
            atomicMin(found_start, own_start);
        }
        memoryBarrierShared();
        barrier();
        uint start = found_start;
        if (start == starts) {
            now.next += kThreads;
        } else {
            now.next = start + 1u;
            now.furrow = start + 1u;
            begin_half(now, false);
        }
    }
    if (gl_LocalInvocationIndex == 0u) {
        progress[field] = now;
    }
}
