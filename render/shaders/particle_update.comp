// Births and motion of particles, one per invocation: all steps since it last ran (particle.gpu-init,
// particle.gpu-update). The same as systems/particles/particle_births.cpp and particle_kernels.cpp. Definitions: that
// of particle_collide.glsl, and, for the common cases, because a software OpenGL executes both sides of every branch,
//   OLD    all particles were born before these steps
//   PLAIN  with OLD: a single step with only gravity and drag
//   STEERED  with PLAIN: and steering
// Techniques: engine.particle-params, particle.circular-list, particle.forces, particle.gpu-init,
//     particle.gpu-state, particle.gpu-update, particle.gpu-update-mrt, particle.million,
//     particle.stateless-script
#version 450
#include "lib/numbers.glsl"
#include "lib/philox.glsl"
#include "particle_gpu.h"

layout(local_size_x = 128) in;  // kParticleGroup
#ifndef PLAIN
layout(binding = kParticleStepsUnit) uniform samplerBuffer steps;
#endif
layout(std430, binding = kParticleStateBinding) buffer State {
    vec4 state[];  // of each slot: position, age; velocity, lifetime
};
layout(std430, binding = kParticleBitsBinding) buffer Bits {
    uint bits[];  // of each slot: random
};
layout(std430, binding = kParticleInstancesBinding) writeonly buffer Instances {
    uint instances[];  // of each simulated particle, oldest first: as particle.vert reads them
};

uniform uint first;       // number of the oldest particle, low word
uniform uint begin;       // first particle to move: index among the simulated ones, from the oldest on
uniform uint end;         // one past the last
uniform uint stride;      // only every stride-th particle is simulated
uniform uint offset;      // from the oldest particle to the oldest simulated one
uniform uint first_slot;  // of the oldest simulated one, on this lap around the ring: may wrap below 0
uniform int first_step;   // to simulate, of those in `steps`
uniform int step_count;   // steps to simulate
uniform int runs;         // texel of the first run of births
uniform int forces;       // texel of the first force of a field
uniform int colliders;    // texel of the first collider
uniform int places;       // texel of the first place of a birth
uniform uint look;
uniform int closed_form;  // states are those at birth
uniform vec3 gravity;
#ifdef PLAIN
uniform vec4 added_dt;     // velocity that is added [m/s], step [s]
uniform float kept;        // fraction of the velocity that is kept
uniform vec2 velocity_dt;  // time at the old velocity and at the new one [s]
#endif
#ifdef STEERED
uniform vec4 steering_origin;  // of the axis; how far directions turn into circles around it
uniform vec4 steering_axis;    // unit; speed that is lost [m/s]
#endif
uniform float back;       // time of drawing before the end of the last step [s]

const float kPi = 3.14159265358979;
// As in particle_kernels.cpp.
const uint kHashX = 0x8da6b343u, kHashY = 0xd8163841u, kHashZ = 0xcb1ab31fu;
const uint kHashMix = 0x7feb352du, kSeedB = 0x68bc21ebu;
const float kCurlScale = 0.887;
const uint kPoint = 0u, kBall = 1u, kSphere = 2u, kDisc = 3u, kCircle = 4u, kBox = 5u, kTorus = 6u;
const uint kRadial = 1u;

struct Particle {
    vec3 position;
    float age;
    vec3 velocity;
    float life;  // negative: sticks to a surface
    uint look_bits;
};

// `tangent`: around the axis, of the length `radius`.
void steer(inout Particle p, vec3 tangent, float radius, float orbit, float loss) {
    float speed = length(p.velocity);
    float left = max(speed - loss, 0.0);
    orbit = radius > 0.0 ? orbit : 0.0;
    p.velocity = (speed > 0.0 ? (1.0 - orbit) * left / speed : 0.0) * p.velocity
                 + (radius > 0.0 ? orbit * left / radius : 0.0) * tangent;
}

#ifdef PLAIN

void move(inout Particle p) {
    if (p.life > 0.0) {  // does not stick
#ifdef STEERED
        vec3 tangent = cross(steering_axis.xyz, p.position - steering_origin.xyz);
        steer(p, tangent, length(tangent), steering_origin.w, steering_axis.w);
#endif
        vec3 old = p.velocity;
        p.velocity = old * kept + added_dt.xyz;
        p.position += old * velocity_dt.x + p.velocity * velocity_dt.y;
    }
    p.age += added_dt.w;
}

#else
#include "particle_collide.glsl"

#ifndef OLD

// ---- random numbers: ecs/base/rng.h

struct Random {
    uvec4 counter;
    uvec2 key;
    uvec4 words;
    uint left;
};

uint next_word(inout Random random) {
    if (random.left == 0u) {
        random.words = philox(random.counter, random.key);
        ++random.counter.x;
        random.left = 4u;
    }
    uint word = random.words[4u - random.left];
    --random.left;
    return word;
}
float next_fraction(inout Random random) {
    return unit_float(next_word(random));
}
float next_signed(inout Random random) {
    return -1.0 + 2.0 * next_fraction(random);
}

vec3 next_vector(inout Random random) {
    float x = next_signed(random);
    float y = next_signed(random);
    return vec3(x, y, next_signed(random));
}

// ---- births: particle_births.cpp

const float kMinKept = 0.37;

vec3 sample_direction(inout Random random) {
    float y = next_signed(random);
    float angle = 2.0 * kPi * next_fraction(random);
    float radius = sqrt(max(1.0 - y * y, 0.0));
    return vec3(radius * cos(angle), y, radius * sin(angle));
}

vec3 sample_shape(uint shape, vec3 size, inout Random random) {
    if (shape == kTorus) {
        float radius = size.y * sqrt(next_fraction(random));
        float turn = 2.0 * kPi * next_fraction(random);
        float angle = 2.0 * kPi * next_fraction(random);
        vec2 tube = radius * vec2(cos(turn), sin(turn));
        return vec3((size.x + tube.x) * cos(angle), tube.y, (size.z + tube.x) * sin(angle));
    }
    if (shape == kBall) {
        float radius = pow(next_fraction(random), 1.0 / 3.0);
        return size * (sample_direction(random) * radius);
    }
    if (shape == kSphere) {
        vec3 direction = sample_direction(random);
        vec3 used = direction * vec3(notEqual(size, vec3(0.0)));
        return size * (used == direction ? direction : used / max(length(used), 1e-15));
    }
    if (shape == kDisc) {
        float radius = sqrt(next_fraction(random));
        float angle = 2.0 * kPi * next_fraction(random);
        return size * vec3(radius * cos(angle), 0.0, radius * sin(angle));
    }
    if (shape == kCircle) {
        float angle = 2.0 * kPi * next_fraction(random);
        return size * vec3(cos(angle), 0.0, sin(angle));
    }
    if (shape == kBox) {
        float x = next_signed(random);
        float y = next_signed(random);
        return size * vec3(x, y, next_signed(random));
    }
    return vec3(0.0);
}

vec3 sample_cone(float lowest, inout Random random) {
    float y = 1.0 - next_fraction(random) * (1.0 - lowest);
    float angle = 2.0 * kPi * next_fraction(random);
    float radius = sqrt(max(1.0 - y * y, 0.0));
    return vec3(radius * cos(angle), y, radius * sin(angle));
}

struct Rows {
    vec4 row[3];
};
Rows pose_at(int texel, float at) {
    Rows rows;
    for (int i = 0; i < 3; ++i) {
        vec4 a = texelFetch(steps, texel + 3 + i);
        rows.row[i] = a + (texelFetch(steps, texel + 6 + i) - a) * at;
    }
    return rows;
}
vec3 transform_vector(Rows m, vec3 v) {
    return vec3(dot(m.row[0].xyz, v), dot(m.row[1].xyz, v), dot(m.row[2].xyz, v));
}

// As Rewind of birth_attributes.h: moves a newborn back in time by the fraction `at` of a step.
void rewind(inout Particle p, float at, int texel) {
    vec4 push = texelFetch(steps, texel + 1);
    vec4 air = texelFetch(steps, texel + 2);
    float old_weight = texelFetch(steps, texel + 9).w;
    vec3 now = p.velocity;
    float ahead = at * push.w;
    p.velocity = air.xyz + (now - air.xyz) * pow(max(air.w, kMinKept), -at) - push.xyz * at;
    p.position -= (p.velocity * old_weight + now * (1.0 - old_weight)) * ahead;
    p.age = -ahead;
}

// Where a birth is, if not at the emitter: GpuBirthPlace.
const uint kAtEmitter = 0xffffffffu, kNoBirth = 0u, kOnSurface = 1u, kSpawn = 2u, kTurnedSpawn = 3u, kDrop = 4u;
struct Place {
    uint kind;
    vec3 position;
    float age;
    vec3 velocity;
    vec4 turn;  // quaternion
};

Place read_place(int texel, uint index) {
    uvec4 range = floatBitsToUint(texelFetch(steps, texel + 17));  // of places: z first texel, w first birth that has one
    if (index < range.w) {
        return Place(kAtEmitter, vec3(0.0), 0.0, vec3(0.0), vec4(0.0, 0.0, 0.0, 1.0));
    }
    int at = places + int(range.z + (index - range.w) * kPlaceTexels);
    vec4 position_age = texelFetch(steps, at);
    vec4 velocity_kind = texelFetch(steps, at + 1);
    return Place(
        floatBitsToUint(velocity_kind.w), position_age.xyz, position_age.w, velocity_kind.xyz, texelFetch(steps, at + 2));
}

// The same scale, turned by a quaternion instead.
Rows turned_to(Rows m, vec4 q) {
    vec3 size;
    for (int i = 0; i < 3; ++i) {
        size[i] = length(vec3(m.row[0][i], m.row[1][i], m.row[2][i]));
    }
    vec3 x = 1.0 - 2.0 * vec3(q.y * q.y + q.z * q.z, q.x * q.x + q.z * q.z, q.x * q.x + q.y * q.y);
    vec3 sum = 2.0 * vec3(q.y * q.z, q.x * q.z, q.x * q.y);
    vec3 turn = 2.0 * q.w * q.xyz;
    m.row[0] = vec4(size * vec3(x.x, sum.z - turn.z, sum.y + turn.y), 0.0);
    m.row[1] = vec4(size * vec3(sum.z + turn.z, x.y, sum.x - turn.x), 0.0);
    m.row[2] = vec4(size * vec3(sum.y - turn.y, sum.x + turn.x, x.z), 0.0);
    return m;
}

// Instant of birth `index` of a step whose runs are in `births`, as a fraction of the step.
float instant_of(uint index, uvec4 births) {
    vec4 run = vec4(0.0);
    for (uint i = 0u; i < births.w; ++i) {
        run = texelFetch(steps, runs + int(births.z + i));
        uint count = floatBitsToUint(run.z);
        if (index < count) {
            break;
        }
        index -= count;
    }
    return clamp(run.x + float(index) * run.y, 0.0, 1.0);
}

// Particle `number` (low word), the birth `index` of the step at `texel`. `at_end`: it is born at the end of the step.
Particle draw_birth(uint number, uint index, int texel, uvec4 births, out bool at_end) {
    uvec4 seed = floatBitsToUint(texelFetch(steps, 0));
    vec4 form = texelFetch(steps, 1);
    vec4 size_speed = texelFetch(steps, 2);
    vec4 rest = texelFetch(steps, 3);
    Random random = Random(uvec4(0u, number, seed.zw), seed.xy, uvec4(0u), 0u);
    Place place = read_place(texel, index);
    at_end = place.kind == kSpawn || place.kind == kTurnedSpawn;
    float at = place.kind == kDrop ? next_fraction(random) : at_end ? 1.0 : instant_of(index, births);
    Rows pose = pose_at(texel, at);
    vec3 origin = vec3(pose.row[0].w, pose.row[1].w, pose.row[2].w);
    if (place.kind != kAtEmitter) {
        origin = place.position;
    }
    if (place.kind == kOnSurface || place.kind == kTurnedSpawn) {
        pose = turned_to(pose, place.turn);
    }
    Particle p;
    if (place.kind == kDrop) {
        p.position = place.position;
        p.velocity = place.velocity;
        p.life = rest.y + rest.z * next_signed(random);
        p.look_bits = next_word(random);
    } else {
        vec3 local = sample_shape(floatBitsToUint(form.y), size_speed.xyz, random);
        bool is_radial = floatBitsToUint(form.z) == kRadial;
        vec3 direction =
            is_radial && local != vec3(0.0) ? normalize(local) : sample_cone(is_radial ? -1.0 : form.w, random);
        vec3 aim = transform_vector(pose, direction);
        float length_of_aim = length(aim);
        aim = length_of_aim > 0.0 ? aim / length_of_aim : vec3(0.0, 1.0, 0.0);
        vec3 added = place.kind == kAtEmitter ? texelFetch(steps, texel + 9).xyz : place.velocity;
        p.velocity = aim * (size_speed.w + rest.x * next_signed(random)) + added;
        p.life = rest.y + rest.z * next_signed(random);
        p.look_bits = next_word(random);
        vec3 size_spread = texelFetch(steps, 4).xyz;
        vec3 velocity_spread = texelFetch(steps, 5).xyz;
        if (size_spread != vec3(0.0)) {
            local += size_spread * next_vector(random);
        }
        if (velocity_spread != vec3(0.0)) {
            p.velocity += transform_vector(pose, velocity_spread * next_vector(random));
        }
        p.position = transform_vector(pose, local) + origin;
    }
    if (at_end) {
        p.age = place.age;
        if (closed_form == 0) {
            p.position += p.velocity * place.age;
        }
    } else if (closed_form != 0) {
        p.age = -at * texelFetch(steps, texel + 1).w;
    } else {
        rewind(p, at, texel);
    }
    float sum = dot(p.position + p.velocity, vec3(1.0)) + p.life;
    if (place.kind == kNoBirth || !is_finite(sum) || abs(sum) >= 1e30) {  // by extreme settings: never visible
        p.position = vec3(0.0);
        p.velocity = vec3(0.0);
        p.life = 0.0;
    }
    return p;
}

#endif
// ---- motion: particle_kernels.cpp

float lattice_value(uvec3 products) {
    uint h = products.x ^ products.y ^ products.z;
    h = (h ^ (h >> 15)) * kHashMix;
    h ^= h >> 13;
    return float(h >> 8) * (1.0 / 8388608.0) - 1.0;
}

vec3 noise_gradient(vec3 at, uint seed) {
    vec3 cell = floor(at);
    vec3 t = at - cell;
    vec3 w = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    vec3 slope = 30.0 * (t * t) * ((t - 1.0) * (t - 1.0));
    uvec3 low = uvec3(ivec3(cell));
    uvec3 a = low * uvec3(kHashX, kHashY, kHashZ);
    uvec3 b = (low + 1u) * uvec3(kHashX, kHashY, kHashZ);
    a.x ^= seed;
    b.x ^= seed;
    float v000 = lattice_value(a);
    float v100 = lattice_value(uvec3(b.x, a.yz));
    float v010 = lattice_value(uvec3(a.x, b.y, a.z));
    float v110 = lattice_value(uvec3(b.xy, a.z));
    float v001 = lattice_value(uvec3(a.xy, b.z));
    float v101 = lattice_value(uvec3(b.x, a.y, b.z));
    float v011 = lattice_value(uvec3(a.x, b.yz));
    float v111 = lattice_value(b);
    float x00 = mix(v000, v100, w.x);
    float x10 = mix(v010, v110, w.x);
    float x01 = mix(v001, v101, w.x);
    float x11 = mix(v011, v111, w.x);
    float dx0 = mix(v100 - v000, v110 - v010, w.y);
    float dx1 = mix(v101 - v001, v111 - v011, w.y);
    return vec3(mix(dx0, dx1, w.z), mix(x10 - x00, x11 - x01, w.z), mix(x01, x11, w.y) - mix(x00, x10, w.y)) * slope;
}

void apply_turbulence(inout Particle p, int texel) {
    vec4 a = texelFetch(steps, texel + 10);
    if (a.w != 0.0) {
        vec4 b = texelFetch(steps, texel + 11);
        uint seed = floatBitsToUint(texelFetch(steps, texel + 14).z);
        vec3 scaled = p.position * b.w;
        p.velocity += cross(noise_gradient(scaled + a.xyz, seed), noise_gradient(scaled + b.xyz, seed ^ kSeedB))
                      * (a.w * kCurlScale);
    }
}

const uint kPush = 0u, kAttract = 1u, kSpring = 2u, kWhirl = 3u, kWind = 4u;

// As acceleration() in force_fields.cpp, times dt.
vec3 force_push(int texel, Particle p) {
    vec4 origin = texelFetch(steps, texel);
    vec4 axis = texelFetch(steps, texel + 1);
    vec4 rest = texelFetch(steps, texel + 2);
    vec3 offset = p.position - origin.xyz;
    float distance2 = dot(offset, offset);
    float strength = axis.w * (rest.y > 0.0 ? max(1.0 - distance2 / (rest.y * rest.y), 0.0) : 1.0);
    uint kind = floatBitsToUint(origin.w);
    if (kind == kPush) {
        return strength * axis.xyz;
    }
    if (kind == kAttract) {
        return distance2 > 0.0 ? -strength * inversesqrt(distance2) * offset : vec3(0.0);
    }
    if (kind == kSpring) {
        return -strength * offset;
    }
    if (kind == kWhirl) {
        vec3 tangent = cross(axis.xyz, offset);
        float radius = length(tangent);
        return radius > 0.0 ? strength / radius * tangent : vec3(0.0);
    }
    return strength * (rest.x * axis.xyz - p.velocity);
}

void apply_forces(inout Particle p, int texel) {
    int count = int(floatBitsToUint(texelFetch(steps, texel + 16).w));
    int first_force = forces + int(floatBitsToUint(texelFetch(steps, texel + 15).w));
    vec3 sum = vec3(0.0);
    for (int i = 0; i < count; ++i) {
        sum += force_push(first_force + i * int(kForceTexels), p);
    }
    p.velocity += sum;
}

void apply_vortex_and_steering(inout Particle p, int texel) {
    vec4 origin = texelFetch(steps, texel + 12);
    vec4 axis = texelFetch(steps, texel + 13);
    vec4 steering = texelFetch(steps, texel + 14);
    vec3 offset = p.position - origin.xyz;
    vec3 tangent = cross(axis.xyz, offset);
    float radius = length(tangent);
    if (radius > 0.0) {
        p.velocity += (origin.w * tangent - axis.w * (offset - dot(offset, axis.xyz) * axis.xyz)) / radius;
    }
    if (steering.x > 0.0 || steering.y > 0.0) {
        steer(p, tangent, radius, steering.x, steering.y);
    }
}

void move(inout Particle p, int texel) {
    vec4 push_dt = texelFetch(steps, texel + 1);
    if (closed_form != 0) {
        p.age += push_dt.w;
        return;
    }
    if (p.life < 0.0) {  // sticks
        p.age += push_dt.w;
        return;
    }
    vec4 air = texelFetch(steps, texel + 2);
    float old_weight = texelFetch(steps, texel + 9).w;
    vec3 start = p.velocity;
    vec3 start_position = p.position;
    apply_turbulence(p, texel);
    apply_forces(p, texel);
    apply_vortex_and_steering(p, texel);
    vec3 old = old_weight == 1.0 ? start : p.velocity;
    p.velocity = air.xyz + (p.velocity + push_dt.xyz - air.xyz) * air.w;
    p.position += old * (push_dt.w * old_weight) + p.velocity * (push_dt.w - push_dt.w * old_weight);
    p.age += push_dt.w;
    vec3 box = texelFetch(steps, texel + 16).xyz;
    vec3 turns = floor((p.position - texelFetch(steps, texel + 15).xyz) / max(box, 1e-30) + 0.5);
    p.position -= mix(vec3(0.0), turns * box, greaterThan(box, vec3(0.0)));
    uvec4 obstacles = floatBitsToUint(texelFetch(steps, texel + 17));  // first collider, number of them
    bool collides = obstacles.y > 0u;
#ifdef DEPTH_COLLISION
    collides = collides || thickness > 0.0;
#endif
    if (collides) {
        collide(
            p, start_position, push_dt.w, colliders + int(obstacles.x), int(obstacles.y), texelFetch(steps, 6));
    }
}

#endif

void main() {
    uint moved = begin + gl_GlobalInvocationID.x;
    if (moved >= end) {
        return;
    }
    uint slot = first_slot + moved * stride;
    vec4 position_age = state[2u * slot];
    vec4 velocity_life = state[2u * slot + 1u];
    Particle p = Particle(position_age.xyz, position_age.w, velocity_life.xyz, velocity_life.w, bits[slot]);
#ifdef PLAIN
    move(p);
#else
    for (int i = 0; i < step_count; ++i) {
        int texel = int(kEmitterTexels) + (first_step + i) * int(kStepTexels);
#ifndef OLD
        uint number = first + offset + moved * stride;
        uvec4 births = floatBitsToUint(texelFetch(steps, texel));
        int since = int(number - births.x);  // wraps
        if (since >= int(births.y)) {
            continue;  // not born yet
        }
        if (since >= 0) {
            bool at_end;
            p = draw_birth(number, uint(since), texel, births, at_end);
            if (at_end) {
                continue;
            }
        }
#endif
        move(p, texel);
    }
#endif
    state[2u * slot] = vec4(p.position, p.age);
    state[2u * slot + 1u] = vec4(p.velocity, p.life);
#ifndef OLD
    bits[slot] = p.look_bits;
#endif

    float age = p.age - back;
    float life = abs(p.life);
    bool is_alive = p.age < life && age >= 0.0;
    float fraction = clamp(age / max(life, 1e-6), 0.0, 1.0);
    vec3 position = p.position - p.velocity * back;
#ifndef PLAIN
    if (closed_form != 0) {
        position = p.position + (p.velocity + 0.5 * gravity * age) * age;
        p.velocity += gravity * age;
    }
#endif
    uint word = kParticleWords * moved;
    instances[word] = floatBitsToUint(position.x);
    instances[word + 1u] = floatBitsToUint(position.y);
    instances[word + 2u] = floatBitsToUint(position.z);
    instances[word + 3u] = look << 16 | uint(fraction * 65535.0);
    instances[word + 4u] = packHalf2x16(p.velocity.xy);
    instances[word + 5u] = is_alive ? packHalf2x16(vec2(p.velocity.z, age)) : kDeadAge;
    instances[word + 6u] = p.look_bits;
}
