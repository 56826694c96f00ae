// Particles of an emitter that bump into each other, at the end of a step (particle.interparticle): as
// systems/particles/particle_balls_system.cpp, but all pairs of a pass move at once. A ball of several contacts yields
// to each by a fraction, the same for both balls of a pair, so that momentum stays and a pair alone parts as on the CPU.
// Balls are sorted by cells; a list of neighbors is made once a step. Nothing is appended and nothing depends on the
// order of invocations. One definition:
//   KEYS   writes an entry for each ball: its cell and index
//   NEAR   lists the neighbors of each ball, as far as the list is long
//   MUTUAL drops neighbors in whose full lists a ball has no place, so that pairs push each other or not at all
//   PUSH   moves overlapping balls apart, not into colliders
//   SPEED  gives pairs that have touched the speed at which they part
//   APPLY  writes positions and velocities back
// and SHAPES, as in particle_collide.glsl.
// Techniques: particle.interparticle
#version 450
#include "lib/numbers.glsl"
#include "particle_gpu.h"

layout(local_size_x = 128) in;  // kParticleGroup

layout(binding = kParticleStepsUnit) uniform samplerBuffer steps;
layout(std430, binding = kParticleStateBinding) buffer State {
    vec4 state[];  // of each slot: position, age; velocity, lifetime
};
layout(std430, binding = kParticleInstancesBinding) buffer Instances {
    uint instances[];
};
layout(std430, binding = kBallEntriesBinding) buffer Entries {
    uvec2 entries[];  // cell, index
};
layout(std430, binding = kBallNearBinding) buffer Near {
    uint near[];  // of each ball: number of neighbors, which of them have touched (bits), then the neighbors
};
layout(std430, binding = kBallReadBinding) readonly buffer Before {
    vec4 before[];  // position, contacts; velocity, free (1) or not (0)
};
layout(std430, binding = kBallWriteBinding) writeonly buffer After {
    vec4 after[];
};

uniform uint count;       // particles from the oldest on
uniform uint born;        // those of them that are born by the end of the step
uniform uint first_slot;  // of the oldest
uniform uint capacity;    // slots
uniform uint size;        // entries
uniform float radius;     // of a ball [m]
uniform float bounce;     // fraction of the approach speed that is kept
uniform float dt;         // [s]
uniform float back;       // time of drawing before the end of the last step [s]
uniform int step_texel;
uniform int colliders;    // texel of the first collider
uniform float wall_radius;  // < 0: no walls

const uint kNearWords = kBallNearWords;
const uint kMaxNear = kNearWords - 2u;
const float kPairRadius = 1.1;     // of the radius: pairs that pushes may bring into contact
const float kBallRestSpeed = 0.2;  // approach speed below which there is no rebound [m/s]
const float kCrowd = 0.6;          // of the contacts, by which each yields less: fewer would overshoot
const uint kFar = 0xfffffffeu, kPad = 0xffffffffu;
const uint kDropped = 0xffffffffu;  // a neighbor

struct Particle {
    vec3 position;
    float age;
    vec3 velocity;
    float life;
    uint look_bits;
};

uint slot_of(uint i) {
    return (first_slot + i) % capacity;
}

// Far apart cells may share a key; distances tell them apart.
uint key_of(ivec3 cell) {
    uvec3 c = uvec3(cell) & 1023u;
    return c.x | c.y << 10 | c.z << 20;
}
ivec3 cell_of(vec3 position) {
    return ivec3(floor(position / (2.0 * kPairRadius * radius)));
}

bool is_alive(uint i) {
    if (i >= born) {
        return false;
    }
    vec4 position_age = state[2u * slot_of(i)];
    return position_age.w < abs(state[2u * slot_of(i) + 1u].w) && is_finite(dot(position_age.xyz, vec3(1.0)));
}

// From ball i to ball k, unit.
vec3 axis_between(vec3 from, vec3 to, uint i, uint k) {
    vec3 between = to - from;
    float distance_ = length(between);
    if (distance_ > 0.0) {
        return between / distance_;
    }
    uint low = min(i, k);  // a direction of the pair
    float angle = float((low * 0x9e3779b9u ^ max(i, k) * 0x85ebca6bu) >> 8) * (6.2831853 / 16777216.0);
    return vec3(cos(angle), 0.0, sin(angle)) * (i < k ? 1.0 : -1.0);
}

// How far ball i yields to ball k, of the whole.
float share_of(float own_free, float other_free, float own_contacts, float other_contacts) {
    float sum = own_free + other_free;
    float damping = max(kCrowd * max(own_contacts, other_contacts), 1.0);
    return sum > 0.0 ? own_free / (sum * damping) : 0.0;
}

#if defined(KEYS)
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= size) {
        return;
    }
    if (i >= count) {
        entries[i] = uvec2(kPad, i);
        return;
    }
    bool alive = is_alive(i);
    vec4 position_age = state[2u * slot_of(i)];
    vec4 velocity_life = state[2u * slot_of(i) + 1u];
    entries[i] = uvec2(alive ? key_of(cell_of(position_age.xyz)) : kFar, i);
    after[2u * i] = vec4(position_age.xyz, 0.0);
    after[2u * i + 1u] = vec4(velocity_life.xyz, velocity_life.w < 0.0 ? 0.0 : 1.0);
    near[kNearWords * i] = 0u;
    near[kNearWords * i + 1u] = 0u;
}
#elif defined(NEAR)
// The first entry whose key is not less.
uint first_entry(uint key) {
    uint low = 0u;
    uint high = size;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (entries[middle].x < key) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count || !is_alive(i)) {
        return;
    }
    vec3 center = before[2u * i].xyz;
    ivec3 cell = cell_of(center);
    float reach = 2.0 * kPairRadius * radius;
    uint found = 0u;
    float touching = 0.0;
    for (int n = 0; n < 27; ++n) {
        uint key = key_of(cell + ivec3(n % 3, n / 3 % 3, n / 9) - 1);
        for (uint at = first_entry(key); at < size && entries[at].x == key && found < kMaxNear; ++at) {
            uint other = entries[at].y;
            vec3 offset = before[2u * other].xyz - center;
            float distance2 = dot(offset, offset);
            if (other != i && distance2 < reach * reach) {
                near[kNearWords * i + 2u + found] = other;
                ++found;
                touching += distance2 < 4.0 * radius * radius ? 1.0 : 0.0;
            }
        }
    }
    near[kNearWords * i] = found;
    after[2u * i] = vec4(center, touching);
    after[2u * i + 1u] = before[2u * i + 1u];
}
#elif defined(MUTUAL)
bool is_listed(uint i, uint other) {
    for (uint n = 0u; n < kMaxNear; ++n) {
        if (near[kNearWords * other + 2u + n] == i) {
            return true;
        }
    }
    return false;
}

// No ball looks for itself where it is dropped, since it is not in the list of one that drops it.
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) {
        return;
    }
    vec4 own = before[2u * i];
    for (uint n = 0u; n < near[kNearWords * i]; ++n) {
        uint other = near[kNearWords * i + 2u + n];
        if (near[kNearWords * other] == kMaxNear && !is_listed(i, other)) {
            near[kNearWords * i + 2u + n] = kDropped;
            own.w -= distance(before[2u * other].xyz, own.xyz) < 2.0 * radius ? 1.0 : 0.0;
        }
    }
    after[2u * i] = own;
    after[2u * i + 1u] = before[2u * i + 1u];
}
#elif defined(PUSH)
#include "particle_collide.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) {
        return;
    }
    vec4 own = before[2u * i];
    vec4 speed = before[2u * i + 1u];
    vec3 push = vec3(0.0);
    float contacts = 0.0;
    uint touched = near[kNearWords * i + 1u];
    uint neighbors = near[kNearWords * i];
    for (uint n = 0u; n < neighbors; ++n) {
        uint other = near[kNearWords * i + 2u + n];
        if (other == kDropped) {
            continue;
        }
        vec4 there = before[2u * other];
        float overlap = 2.0 * radius - distance(own.xyz, there.xyz);
        if (overlap > 0.0) {
            push -= overlap * share_of(speed.w, before[2u * other + 1u].w, own.w, there.w)
                    * axis_between(own.xyz, there.xyz, i, other);
            touched |= 1u << n;
            contacts += 1.0;
        }
    }
    vec3 moved = own.xyz + push;
    uvec4 obstacles = floatBitsToUint(texelFetch(steps, step_texel + 17));
    if (wall_radius >= 0.0 && obstacles.y > 0u && neighbors > 0u && speed.w > 0.0) {
        Particle p = Particle(moved, 0.0, vec3(0.0), 1.0, 0u);
        vec4 response = vec4(0.0, 1.0, wall_radius, uintBitsToFloat(kBounce));
        collide(p, own.xyz, 0.0, colliders + int(obstacles.x), int(obstacles.y), response);
        moved = p.position;
    }
    near[kNearWords * i + 1u] = touched;
    after[2u * i] = vec4(moved, contacts);
    after[2u * i + 1u] = speed;
}
#elif defined(SPEED)
// Velocities at the end of the step and before it: state still holds what balls had before they were pushed.
vec3 pushed_by(uint i) {
    return before[2u * i].xyz - state[2u * slot_of(i)].xyz;
}

uniform int is_first;  // adds the pushes, which move balls apart within the step

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) {
        return;
    }
    vec4 own = before[2u * i];
    vec4 speed = before[2u * i + 1u];
    uint touched = near[kNearWords * i + 1u];
    if (is_first != 0) {
        after[2u * i] = vec4(own.xyz, float(bitCount(touched)));
        after[2u * i + 1u] = vec4(speed.xyz + pushed_by(i) / dt, speed.w);
        return;
    }
    vec3 old = state[2u * slot_of(i) + 1u].xyz;
    vec3 change = vec3(0.0);
    for (uint n = 0u; n < near[kNearWords * i]; ++n) {
        if ((touched & 1u << n) == 0u) {
            continue;
        }
        uint other = near[kNearWords * i + 2u + n];
        vec4 there = before[2u * other];
        vec4 its_speed = before[2u * other + 1u];
        vec3 axis = axis_between(own.xyz, there.xyz, i, other);
        float approach = dot(old - state[2u * slot_of(other) + 1u].xyz, axis);
        float parting = dot(its_speed.xyz - speed.xyz, axis);
        float wanted = approach > kBallRestSpeed ? bounce * approach : max(-approach, 0.0);
        change += (parting - wanted) * share_of(speed.w, its_speed.w, own.w, there.w) * axis;
    }
    after[2u * i] = own;
    after[2u * i + 1u] = vec4(speed.xyz + change, speed.w);
}
#else
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count || near[kNearWords * i] == 0u) {
        return;
    }
    uint slot = slot_of(i);
    vec3 position = before[2u * i].xyz;
    vec3 velocity = before[2u * i + 1u].xyz;
    state[2u * slot].xyz = position;
    state[2u * slot + 1u].xyz = velocity;
    uvec3 drawn = floatBitsToUint(position - velocity * back);
    uint word = kParticleWords * i;
    instances[word] = drawn.x;
    instances[word + 1u] = drawn.y;
    instances[word + 2u] = drawn.z;
    instances[word + 4u] = packHalf2x16(velocity.xy);
    float age = unpackHalf2x16(instances[word + 5u]).y;
    instances[word + 5u] = instances[word + 5u] == kDeadAge ? kDeadAge : packHalf2x16(vec2(velocity.z, age));
}
#endif
