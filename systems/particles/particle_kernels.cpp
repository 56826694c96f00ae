#include "systems/particles/particle_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/particles/particle_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

#ifndef LIMN_PARTICLE_CONSTANTS
#define LIMN_PARTICLE_CONSTANTS
namespace limn::particles {

// Multipliers of the lattice hash: odd, without pattern in their bits.
inline constexpr std::uint32_t kHashX = 0x8da6b343u;
inline constexpr std::uint32_t kHashY = 0xd8163841u;
inline constexpr std::uint32_t kHashZ = 0xcb1ab31fu;
inline constexpr std::uint32_t kHashMix = 0x7feb352du;
inline constexpr std::uint32_t kSeedB = 0x68bc21ebu;  // of the second field of curl noise
inline constexpr float kCurlScale = 0.887f;           // root mean square 1, measured

}  // namespace limn::particles
#endif

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {

// Each returns the number of particles processed; the scalar version handles the remainder.

#if HWY_TARGET == HWY_SCALAR  // no vectors here

std::size_t move_particles_vector(const ParticleBlock&, const ParticleStep&, std::size_t&) {
    return 0;
}
std::size_t stir_particles_vector(const ParticleBlock&, const Turbulence&, float) {
    return 0;
}
std::size_t wrap_axis_vector(float*, std::size_t, float, float) {
    return 0;
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using Words = hn::RebindToUnsigned<Floats>;
using Ints = hn::RebindToSigned<Floats>;
using V = hn::Vec<Floats>;
using U = hn::Vec<Words>;
constexpr Floats d;
constexpr Words du;
constexpr Ints di;

/// The first `count` lanes of a vector at `p`, the others 0; all of them for a whole vector.
HWY_INLINE V load_part(const float* p, std::size_t count) {
    return count < hn::Lanes(d) ? hn::MaskedLoad(hn::FirstN(d, count), d, p) : hn::LoadU(d, p);
}
HWY_INLINE void store_part(V values, float* p, std::size_t count) {
    if (count < hn::Lanes(d)) {
        hn::BlendedStore(values, hn::FirstN(d, count), d, p);
    } else {
        hn::StoreU(values, d, p);
    }
}

/// Calls run(first, count) for whole vectors, then for what is left if that can be loaded without
/// touching what is behind it. Returns how many elements that were.
template <typename Run>
HWY_INLINE std::size_t each_vector(std::size_t count, Run run) {
    const std::size_t n = hn::Lanes(d);
    std::size_t i = 0;
    for (; i + n <= count; i += n) {
        run(i, n);
    }
#if !HWY_MEM_OPS_MIGHT_FAULT
    if (i < count) {
        run(i, count - i);
        i = count;
    }
#endif
    return i;
}

HWY_INLINE void move_axis(
    float* HWY_RESTRICT x, float* HWY_RESTRICT v, std::size_t count, float push_step,
    float air_speed, const ParticleStep& step) {
    const V push = hn::Set(d, push_step);
    const V air = hn::Set(d, air_speed);
    const V keep = hn::Set(d, step.keep);
    const V old_dt = hn::Set(d, step.old_dt());
    const V new_dt = hn::Set(d, step.new_dt());
    each_vector(count, [&](std::size_t i, std::size_t n) HWY_ATTR {
        const V old = load_part(v + i, n);
        const V next = hn::Add(air, hn::Mul(hn::Sub(hn::Add(old, push), air), keep));
        store_part(next, v + i, n);
        const V way = hn::Add(hn::Mul(old, old_dt), hn::Mul(next, new_dt));
        store_part(hn::Add(load_part(x + i, n), way), x + i, n);
    });
}

/// Axis after axis: arrays that begin at the same offset of a page, as large ones do, would
/// displace each other from the cache if all were walked at once.
std::size_t
move_particles_vector(const ParticleBlock& b, const ParticleStep& step, std::size_t& dead) {
    const Vec3 push = step.gravity * step.dt;
    move_axis(b.x, b.vx, b.count, push.x, step.air.x, step);
    move_axis(b.y, b.vy, b.count, push.y, step.air.y, step);
    move_axis(b.z, b.vz, b.count, push.z, step.air.z, step);
    const V dt = hn::Set(d, step.dt);
    return each_vector(b.count, [&](std::size_t i, std::size_t n) HWY_ATTR {
        const V age = hn::Add(load_part(b.age + i, n), dt);
        store_part(age, b.age + i, n);
        const auto old = hn::Ge(age, load_part(b.life + i, n));
        // Lanes behind the end do not count.
        dead += hn::CountTrue(d, n < hn::Lanes(d) ? hn::And(old, hn::FirstN(d, n)) : old);
    });
}

/// -2^23 .. 2^23 of a lattice point, from the products of its coordinates with the multipliers.
/// Sums of these round as those of values scaled to -1 .. 1 do: the scale is a power of two.
HWY_INLINE V lattice_value(U x, U y, U z) {
    U h = hn::Xor3(x, y, z);
    h = hn::Mul(hn::Xor(h, hn::ShiftRight<15>(h)), hn::Set(du, particles::kHashMix));
    h = hn::Xor3(h, hn::ShiftRight<13>(h), hn::Set(du, 0x80000000u));
    return hn::ConvertTo(d, hn::ShiftRight<8>(hn::BitCast(di, h)));
}

/// Quintic weight of the upper lattice point, and its slope.
struct Fade {
    V weight;
    V slope;
};
HWY_INLINE Fade fade(V t) {
    const V t2 = hn::Mul(t, t);
    const V inner = hn::Add(
        hn::Mul(t, hn::Sub(hn::Mul(t, hn::Set(d, 6.0f)), hn::Set(d, 15.0f))), hn::Set(d, 10.0f));
    const V rest = hn::Sub(t, hn::Set(d, 1.0f));
    return {
        hn::Mul(hn::Mul(t2, t), inner),
        hn::Mul(hn::Mul(hn::Set(d, 30.0f), t2), hn::Mul(rest, rest))};
}
HWY_INLINE V blend(V a, V b, V t) {
    return hn::Add(a, hn::Mul(hn::Sub(b, a), t));
}

struct Gradient {
    V x, y, z;
};
HWY_INLINE Gradient noise_gradient(V px, V py, V pz, std::uint32_t seed) {
    const V cx = hn::Floor(px);
    const V cy = hn::Floor(py);
    const V cz = hn::Floor(pz);
    const Fade fx = fade(hn::Sub(px, cx));
    const Fade fy = fade(hn::Sub(py, cy));
    const Fade fz = fade(hn::Sub(pz, cz));
    const U step_x = hn::Set(du, particles::kHashX);
    const U step_y = hn::Set(du, particles::kHashY);
    const U step_z = hn::Set(du, particles::kHashZ);
    const U x0 =
        hn::Xor(hn::Mul(hn::BitCast(du, hn::ConvertTo(di, cx)), step_x), hn::Set(du, seed));
    const U y0 = hn::Mul(hn::BitCast(du, hn::ConvertTo(di, cy)), step_y);
    const U z0 = hn::Mul(hn::BitCast(du, hn::ConvertTo(di, cz)), step_z);
    const U x1 = hn::Xor(
        hn::Mul(hn::BitCast(du, hn::Add(hn::ConvertTo(di, cx), hn::Set(di, 1))), step_x),
        hn::Set(du, seed));
    const U y1 = hn::Add(y0, step_y);
    const U z1 = hn::Add(z0, step_z);
    const V v000 = lattice_value(x0, y0, z0);
    const V v100 = lattice_value(x1, y0, z0);
    const V v010 = lattice_value(x0, y1, z0);
    const V v110 = lattice_value(x1, y1, z0);
    const V v001 = lattice_value(x0, y0, z1);
    const V v101 = lattice_value(x1, y0, z1);
    const V v011 = lattice_value(x0, y1, z1);
    const V v111 = lattice_value(x1, y1, z1);
    const V x00 = blend(v000, v100, fx.weight);
    const V x10 = blend(v010, v110, fx.weight);
    const V x01 = blend(v001, v101, fx.weight);
    const V x11 = blend(v011, v111, fx.weight);
    const V y0w = blend(x00, x10, fy.weight);
    const V y1w = blend(x01, x11, fy.weight);
    const V dx0 = blend(hn::Sub(v100, v000), hn::Sub(v110, v010), fy.weight);
    const V dx1 = blend(hn::Sub(v101, v001), hn::Sub(v111, v011), fy.weight);
    const V unit = hn::Set(d, 0x1p-23f);
    return {
        hn::Mul(hn::Mul(blend(dx0, dx1, fz.weight), unit), fx.slope),
        hn::Mul(hn::Mul(blend(hn::Sub(x10, x00), hn::Sub(x11, x01), fz.weight), unit), fy.slope),
        hn::Mul(hn::Mul(hn::Sub(y1w, y0w), unit), fz.slope)};
}

HWY_INLINE void add_to(float* HWY_RESTRICT v, V push) {
    hn::StoreU(hn::Add(hn::LoadU(d, v), push), d, v);
}
HWY_INLINE V cross_axis(V ay, V az, V by, V bz) {
    return hn::Sub(hn::Mul(ay, bz), hn::Mul(az, by));
}

std::size_t stir_particles_vector(const ParticleBlock& b, const Turbulence& t, float dt) {
    const std::size_t n = hn::Lanes(d);
    const V per_size = hn::Set(d, 1.0f / t.size);
    const V scale = hn::Set(d, t.strength * particles::kCurlScale * dt);
    const auto place = [&](const float* x, float drift) {
        return hn::Add(hn::Mul(hn::LoadU(d, x), per_size), hn::Set(d, drift));
    };
    std::size_t i = 0;
    for (; i + n <= b.count; i += n) {
        const Gradient p = noise_gradient(
            place(b.x + i, t.drift_a.x), place(b.y + i, t.drift_a.y), place(b.z + i, t.drift_a.z),
            t.seed);
        const Gradient q = noise_gradient(
            place(b.x + i, t.drift_b.x), place(b.y + i, t.drift_b.y), place(b.z + i, t.drift_b.z),
            t.seed ^ particles::kSeedB);
        add_to(b.vx + i, hn::Mul(cross_axis(p.y, p.z, q.y, q.z), scale));
        add_to(b.vy + i, hn::Mul(cross_axis(p.z, p.x, q.z, q.x), scale));
        add_to(b.vz + i, hn::Mul(cross_axis(p.x, p.y, q.x, q.y), scale));
    }
    return i;
}

std::size_t wrap_axis_vector(float* x, std::size_t count, float center, float size) {
    const std::size_t n = hn::Lanes(d);
    const V middle = hn::Set(d, center);
    const V extent = hn::Set(d, size);
    const V per_size = hn::Set(d, 1.0f / size);
    const V half = hn::Set(d, 0.5f);
    std::size_t i = 0;
    for (; i + n <= count; i += n) {
        const V old = hn::LoadU(d, x + i);
        const V turns = hn::Floor(hn::Add(hn::Mul(hn::Sub(old, middle), per_size), half));
        hn::StoreU(hn::Sub(old, hn::Mul(turns, extent)), d, x + i);
    }
    return i;
}

#endif

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(move_particles_vector);
HWY_EXPORT(stir_particles_vector);
HWY_EXPORT(wrap_axis_vector);

namespace {

float lattice_value(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    std::uint32_t h = x ^ y ^ z;
    h = (h ^ (h >> 15)) * particles::kHashMix;
    h ^= h >> 13;
    return static_cast<float>(h >> 8) * 0x1p-23f - 1.0f;
}

struct Fade {
    float weight;
    float slope;
};
Fade fade(float t) {
    const float rest = t - 1.0f;
    return {t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f), 30.0f * (t * t) * (rest * rest)};
}
float blend(float a, float b, float t) {
    return a + (b - a) * t;
}

}  // namespace

ParticleBlock ParticleBlock::from(std::size_t first) const {
    return {x + first,  y + first,   z + first,    vx + first,   vy + first,
            vz + first, age + first, life + first, count - first};
}

ParticleBlock particle_block(ParticlePool& pool, std::size_t first, std::size_t count) {
    const ParticleBlock all = {pool.x.data(),   pool.y.data(),    pool.z.data(),
                               pool.vx.data(),  pool.vy.data(),   pool.vz.data(),
                               pool.age.data(), pool.life.data(), first + count};
    return all.from(first);
}

std::size_t move_particles_scalar(const ParticleBlock& b, const ParticleStep& step) {
    const Vec3 push = step.gravity * step.dt;
    std::size_t dead = 0;
    float* const places[] = {b.x, b.y, b.z};
    float* const speeds[] = {b.vx, b.vy, b.vz};
    for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < b.count; ++i) {
            const float old = speeds[axis][i];
            const float next = step.air[axis] + (old + push[axis] - step.air[axis]) * step.keep;
            speeds[axis][i] = next;
            places[axis][i] = places[axis][i] + (old * step.old_dt() + next * step.new_dt());
        }
    }
    for (std::size_t i = 0; i < b.count; ++i) {
        b.age[i] += step.dt;
        dead += b.age[i] >= b.life[i] ? 1 : 0;
    }
    return dead;
}

std::size_t move_particles(const ParticleBlock& block, const ParticleStep& step) {
    std::size_t dead = 0;
    const std::size_t done = HWY_DYNAMIC_DISPATCH(move_particles_vector)(block, step, dead);
    return dead + move_particles_scalar(block.from(done), step);
}

Vec3 noise_gradient(const Vec3& at, std::uint32_t seed) {
    const Vec3 cell = glm::floor(at);
    const Fade fx = fade(at.x - cell.x);
    const Fade fy = fade(at.y - cell.y);
    const Fade fz = fade(at.z - cell.z);
    const auto lattice = [](float c) {  // saturates, as vectors do
        constexpr float kEnd = 0x1p31f;
        const std::int32_t whole = c >= kEnd    ? std::numeric_limits<std::int32_t>::max()
                                   : c >= -kEnd ? static_cast<std::int32_t>(c)
                                                : std::numeric_limits<std::int32_t>::min();
        return static_cast<std::uint32_t>(whole);
    };
    const std::uint32_t x0 = (lattice(cell.x) * particles::kHashX) ^ seed;
    const std::uint32_t y0 = lattice(cell.y) * particles::kHashY;
    const std::uint32_t z0 = lattice(cell.z) * particles::kHashZ;
    const std::uint32_t x1 = ((lattice(cell.x) + 1) * particles::kHashX) ^ seed;
    const std::uint32_t y1 = y0 + particles::kHashY;
    const std::uint32_t z1 = z0 + particles::kHashZ;
    const float v000 = lattice_value(x0, y0, z0);
    const float v100 = lattice_value(x1, y0, z0);
    const float v010 = lattice_value(x0, y1, z0);
    const float v110 = lattice_value(x1, y1, z0);
    const float v001 = lattice_value(x0, y0, z1);
    const float v101 = lattice_value(x1, y0, z1);
    const float v011 = lattice_value(x0, y1, z1);
    const float v111 = lattice_value(x1, y1, z1);
    const float x00 = blend(v000, v100, fx.weight);
    const float x10 = blend(v010, v110, fx.weight);
    const float x01 = blend(v001, v101, fx.weight);
    const float x11 = blend(v011, v111, fx.weight);
    const float y0w = blend(x00, x10, fy.weight);
    const float y1w = blend(x01, x11, fy.weight);
    const float dx0 = blend(v100 - v000, v110 - v010, fy.weight);
    const float dx1 = blend(v101 - v001, v111 - v011, fy.weight);
    return {
        blend(dx0, dx1, fz.weight) * fx.slope, blend(x10 - x00, x11 - x01, fz.weight) * fy.slope,
        (y1w - y0w) * fz.slope};
}

namespace {

/// grad a x grad b, not yet scaled.
Vec3 curl(const Vec3& at, const Turbulence& t) {
    const Vec3 place = at * (1.0f / t.size);
    const Vec3 p = noise_gradient(place + t.drift_a, t.seed);
    const Vec3 q = noise_gradient(place + t.drift_b, t.seed ^ particles::kSeedB);
    return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

}  // namespace

Vec3 curl_noise(const Vec3& at, const Turbulence& turbulence) {
    return curl(at, turbulence) * (turbulence.strength * particles::kCurlScale);
}

void stir_particles_scalar(const ParticleBlock& b, const Turbulence& turbulence, float dt) {
    const float scale = turbulence.strength * particles::kCurlScale * dt;
    for (std::size_t i = 0; i < b.count; ++i) {
        const Vec3 push = curl({b.x[i], b.y[i], b.z[i]}, turbulence) * scale;
        b.vx[i] += push.x;
        b.vy[i] += push.y;
        b.vz[i] += push.z;
    }
}

void stir_particles(const ParticleBlock& block, const Turbulence& turbulence, float dt) {
    const std::size_t done = HWY_DYNAMIC_DISPATCH(stir_particles_vector)(block, turbulence, dt);
    stir_particles_scalar(block.from(done), turbulence, dt);
}

void whirl_particles(const ParticleBlock& b, const Vortex& vortex, float dt) {
    const Vec3& a = vortex.axis;
    for (std::size_t i = 0; i < b.count; ++i) {
        const Vec3 offset = Vec3(b.x[i], b.y[i], b.z[i]) - vortex.origin;
        const float along = offset.x * a.x + offset.y * a.y + offset.z * a.z;
        const Vec3 out = offset - along * a;
        const float length2 = out.x * out.x + out.y * out.y + out.z * out.z;
        const float share = length2 > 0 ? dt / std::sqrt(length2) : 0.0f;
        const Vec3 tangent = {
            a.y * out.z - a.z * out.y, a.z * out.x - a.x * out.z, a.x * out.y - a.y * out.x};
        b.vx[i] += share * (vortex.around * tangent.x - vortex.toward * out.x);
        b.vy[i] += share * (vortex.around * tangent.y - vortex.toward * out.y);
        b.vz[i] += share * (vortex.around * tangent.z - vortex.toward * out.z);
    }
}

void steer_particles(const ParticleBlock& b, const Steering& steering) {
    const Vec3& a = steering.axis;
    for (std::size_t i = 0; i < b.count; ++i) {
        const Vec3 velocity = {b.vx[i], b.vy[i], b.vz[i]};
        const float speed =
            std::sqrt(velocity.x * velocity.x + velocity.y * velocity.y + velocity.z * velocity.z);
        const Vec3 offset = Vec3(b.x[i], b.y[i], b.z[i]) - steering.origin;
        const Vec3 tangent = {
            a.y * offset.z - a.z * offset.y, a.z * offset.x - a.x * offset.z,
            a.x * offset.y - a.y * offset.x};
        const float reach =
            std::sqrt(tangent.x * tangent.x + tangent.y * tangent.y + tangent.z * tangent.z);
        const float orbit = reach > 0 ? steering.orbit : 0.0f;
        const float left = std::max(speed - steering.loss, 0.0f);
        const float along = speed > 0 ? (1.0f - orbit) * left / speed : 0.0f;
        const float around = reach > 0 ? orbit * left / reach : 0.0f;
        b.vx[i] = along * velocity.x + around * tangent.x;
        b.vy[i] = along * velocity.y + around * tangent.y;
        b.vz[i] = along * velocity.z + around * tangent.z;
    }
}

namespace {

void wrap_axis(float* x, std::size_t count, float center, float size) {
    const float per_size = 1.0f / size;
    for (std::size_t i = 0; i < count; ++i) {
        const float turns = std::floor((x[i] - center) * per_size + 0.5f);
        x[i] = x[i] - turns * size;
    }
}

}  // namespace

void wrap_particles_scalar(const ParticleBlock& b, const Vec3& center, const Vec3& size) {
    float* const places[] = {b.x, b.y, b.z};
    for (int axis = 0; axis < 3; ++axis) {
        if (size[axis] > 0 && std::isfinite(center[axis])) {
            wrap_axis(places[axis], b.count, center[axis], size[axis]);
        }
    }
}

void wrap_particles(const ParticleBlock& b, const Vec3& center, const Vec3& size) {
    float* const places[] = {b.x, b.y, b.z};
    for (int axis = 0; axis < 3; ++axis) {
        if (size[axis] > 0 && std::isfinite(center[axis])) {
            const std::size_t done = HWY_DYNAMIC_DISPATCH(wrap_axis_vector)(
                places[axis], b.count, center[axis], size[axis]);
            wrap_axis(places[axis] + done, b.count - done, center[axis], size[axis]);
        }
    }
}

}  // namespace limn
#endif  // HWY_ONCE
