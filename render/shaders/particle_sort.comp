// Sorts the particles of an emitter from back to front (particle.distance-sort, particle.bitonic-sort). One definition
// at most:
//   KEYS    writes an entry for each particle, and fills up with entries that come last
//   PASS    one pass of the bitonic sort, an invocation for each pair
//   LOCAL   all passes of the runs `run` .. `last_run` whose partners are less than 1,024 apart, in shared memory
//   none    gathers the particles in sorted order
// Techniques: particle.bitonic-sort, particle.distance-sort, particle.sort-amortised
#version 450
#include "lib/numbers.glsl"
#include "particle_gpu.h"

layout(local_size_x = 512) in;  // kSortGroup

// Of each particle, the key and the index by birth, counted from the oldest at the time the keys were read.
layout(std430, binding = kSortEntriesBinding) buffer Entries {
    uvec2 entries[];
};
#if defined(KEYS) || !(defined(PASS) || defined(LOCAL))
layout(std430, binding = kSortInstancesBinding) readonly buffer Instances {
    uint instances[];
};
#endif
#if !(defined(KEYS) || defined(PASS) || defined(LOCAL))
layout(std430, binding = kSortedInstancesBinding) writeonly buffer Sorted {
    uint in_order[];
};
#endif

uniform uint count;  // particles
uniform uint size;   // entries: a power of two
uniform vec3 eye;
uniform vec3 forward;
uniform uint run;
uniform uint partner;
uniform uint last_run;
uniform uint sorted_count;  // particles at the time the keys were read
uniform uint died;          // number of those that have died since, the oldest
uniform uint total;         // particles to write

const uint kDead = 0xfffffffeu;  // after all others
const uint kPad = 0xffffffffu;   // last

// As depth_key() in ecs/base/depth_sort.h: ascends from far to near, NaN first.
uint depth_key(float depth) {
    if (is_nan(depth)) {
        return 0u;
    }
    uint bits = floatBitsToUint(depth + 0.0);
    bits = (bits >> 31) != 0u ? ~bits : bits | 0x80000000u;
    return ~bits;
}

// Along the view axis, with the rounding of the CPU, so that equal depths stay equal.
float depth_of(vec3 position) {
    vec3 away = position - eye;
    precise float depth = away.x * forward.x + away.y * forward.y + away.z * forward.z;
    return depth;
}

bool comes_after(uvec2 a, uvec2 b) {
    return a.x > b.x || (a.x == b.x && a.y > b.y);
}

#if defined(KEYS)
void main() {
    uint i = gl_GlobalInvocationID.x;
    uint key = kPad;
    if (i < count) {
        uint word = kParticleWords * i;
        vec3 position = uintBitsToFloat(uvec3(instances[word], instances[word + 1u], instances[word + 2u]));
        bool is_dead = unpackHalf2x16(instances[word + 5u]).y < 0.0;
        key = is_dead ? kDead : min(depth_key(depth_of(position)), kDead - 1u);
    }
    if (i < size) {
        entries[i] = uvec2(key, i);
    }
}
#elif defined(PASS)
void main() {
    uint pair = gl_GlobalInvocationID.x;
    uint i = 2u * pair - (pair & (partner - 1u));
    uvec2 a = entries[i];
    uvec2 b = entries[i + partner];
    if (comes_after(a, b) == ((i & run) == 0u)) {
        entries[i] = b;
        entries[i + partner] = a;
    }
}
#elif defined(LOCAL)
shared uvec2 items[1024];
void main() {
    uint thread = gl_LocalInvocationID.x;
    uint base = 1024u * gl_WorkGroupID.x;
    items[thread] = entries[base + thread];
    items[thread + 512u] = entries[base + thread + 512u];
    for (uint r = run; r <= last_run; r *= 2u) {
        for (uint p = min(r / 2u, 512u); p > 0u; p /= 2u) {
            barrier();
            uint i = 2u * thread - (thread & (p - 1u));
            uvec2 a = items[i];
            uvec2 b = items[i + p];
            if (comes_after(a, b) == (((base + i) & r) == 0u)) {
                items[i] = b;
                items[i + p] = a;
            }
        }
    }
    barrier();
    entries[base + thread] = items[thread];
    entries[base + thread + 512u] = items[thread + 512u];
}
#else
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= total) {
        return;
    }
    // Particles born since then are last, in the order of births.
    uint index = (i < sorted_count ? entries[i].y : i) - died;
    bool exists = index < count;  // false below 0, too, which wraps
    for (uint word = 0u; word < kParticleWords; ++word) {
        uint absent = word == 5u ? kDeadAge : 0u;
        in_order[kParticleWords * i + word] = exists ? instances[kParticleWords * index + word] : absent;
    }
}
#endif
