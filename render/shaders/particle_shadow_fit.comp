// Fits the maps of particle shadows to casters that the GPU moves (render/particles/particle_shadow_pass.h).
// Definition:
//   RECORD  the rows of the maps, by one invocation; else the ranges of positions of an emitter's particles
// Techniques: particle.gpu-shadow
#version 450
#include "lib/particle.glsl"

layout(local_size_x = 128) in;  // kParticleGroup

// Lowest and highest of s, t and depth [m], as words that are ordered as the floats are.
layout(std430, binding = kShadowRangesBinding) buffer Ranges {
    uint lowest[3];
    uint highest[3];
};

uniform vec3 light_right;  // unit, along the map's columns and rows, and where the light goes
uniform vec3 light_up;
uniform vec3 light_axis;
uniform vec3 origin;  // of depths
uniform float spot_range;  // of a spot [m]; < 0: the sun

uint ordered(float x) {
    uint bits = floatBitsToUint(x);
    return (bits >> 31) != 0u ? ~bits : bits | 0x80000000u;
}
float from_ordered(uint word) {
    return uintBitsToFloat((word >> 31) != 0u ? word & 0x7fffffffu : ~word);
}

#ifdef RECORD
layout(std430, binding = kShadowRecordBinding) writeonly buffer Record {
    vec4 rows[];  // ParticleShadowRecord
};
layout(binding = kParticleShadowUnit) uniform samplerBuffer particle_shadow;  // the record to fit: of a spot, rows 0, 1, 3 stay
uniform float border;      // around the casters, as a fraction of the map
uniform float min_extent;  // [m]

// Row of an affine map from low to high along `axis`.
vec4 row_along(vec3 axis, float low, float high) {
    return vec4(axis, -low) / max(high - low, min_extent);
}

void main() {
    if (gl_GlobalInvocationID.x > 0u) {
        return;
    }
    vec3 low = vec3(from_ordered(lowest[0]), from_ordered(lowest[1]), from_ordered(lowest[2]));
    vec3 high = vec3(from_ordered(highest[0]), from_ordered(highest[1]), from_ordered(highest[2]));
    bool none = low.z > high.z;
    vec3 margin = border * max(high - low, vec3(min_extent));
    bool is_spot = spot_range >= 0.0;
    vec4 row3 = is_spot ? texelFetch(particle_shadow, 3) : vec4(0.0, 0.0, 0.0, 1.0);
    rows[0] = is_spot ? texelFetch(particle_shadow, 0) : row_along(light_right, low.x - margin.x, high.x + margin.x);
    rows[1] = is_spot ? texelFetch(particle_shadow, 1) : row_along(light_up, low.y - margin.y, high.y + margin.y);
    rows[2] = row_along(light_axis, low.z + dot(light_axis, origin), high.z + dot(light_axis, origin));
    rows[3] = row3;
    rows[4] = vec4(none ? -1.0 : texelFetch(particle_shadow, 4).z, 1.0 / max(high.z - low.z, min_extent), 0.0, 0.0);
}
#else
uniform uint count;   // particles
uniform uint stride;  // invocations

void main() {
    vec3 low = vec3(1e30);
    vec3 high = vec3(-1e30);
    for (uint i = gl_GlobalInvocationID.x; i < count; i += stride) {
        Particle p = read_particle(int(i));
        float radius = 0.7072 * size_of(p, look_texel(p.look, 0u));
        vec3 offset = p.position - origin;
        vec3 position = vec3(dot(p.position, light_right), dot(p.position, light_up), dot(offset, light_axis));
        bool casts = !p.is_dead && radius > 0.0 && abs(position.x + position.y + position.z + radius) < 1e20;
        bool lit = spot_range < 0.0 || (position.z + radius > 0.0 && position.z - radius < spot_range);
        if (casts && lit) {
            low = min(low, position - radius);
            high = max(high, position + radius);
        }
    }
    if (low.z <= high.z) {
        for (int axis = 0; axis < 3; ++axis) {
            atomicMin(lowest[axis], ordered(low[axis]));
            atomicMax(highest[axis], ordered(high[axis]));
        }
    }
}
#endif
