#include "systems/particles/particle_kernels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/particles/particle_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

// Techniques: engine.space-dust, particle.gpu-update, particle.integrator, particle.system

#ifndef LIMN_PARTICLE_CONSTANTS
#define LIMN_PARTICLE_CONSTANTS
namespace limn::particles {

// Multipliers of the lattice hash: odd, without pattern in their bits.
inline constexpr std::uint32_t kHashX = 0x8da6b343u;
inline constexpr std::uint32_t kHashY = 0xd8163841u;
inline constexpr std::uint32_t kHashZ = 0xcb1ab31fu;
inline constexpr std::uint32_t kHashMix = 0x7feb352du;
inline constexpr std::uint32_t kSeedB = 0x68bc21ebu;  // of the second field of curl noise

// Added to whole numbers up to 2^22, it leaves them in the lowest bits of the sum. Beyond, where
// floats have next to no fraction, the lattice is a different one.
inline constexpr float kWhole = 0x1.8p23f;
inline constexpr auto kWholeBits = std::bit_cast<std::uint32_t>(kWhole);

inline constexpr float kCurlScale = 0.887f;       // root mean square 1, measured
inline constexpr float kRawUnit = 30 * 0x1p-31f;  // of raw_gradient

/// From the cross product of two raw gradients to an acceleration.
inline float raw_curl_scale(const Turbulence& turbulence) {
    return turbulence.strength * (kCurlScale * kRawUnit * kRawUnit);
}

}  // namespace limn::particles
#endif

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {

// Each returns the number of particles processed; the scalar version handles the remainder.

#if HWY_TARGET == HWY_SCALAR  // no SIMD

std::size_t move_particles_vector(const ParticleBlock&, const ParticleStep&, std::size_t&) {
    return 0;
}
std::size_t apply_turbulence_vector(const ParticleBlock&, const Turbulence&, float) {
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
template <typename D>
HWY_INLINE hn::Vec<D> load_part(D tag, const float* p, std::size_t count) {
    return count < hn::Lanes(tag) ? hn::MaskedLoad(hn::FirstN(tag, count), tag, p)
                                  : hn::LoadU(tag, p);
}
template <typename D>
HWY_INLINE void store_part(D tag, hn::Vec<D> values, float* p, std::size_t count) {
    if (count < hn::Lanes(tag)) {
        hn::BlendedStore(values, hn::FirstN(tag, count), tag, p);
    } else {
        hn::StoreU(values, tag, p);
    }
}

template <typename D, typename Run>
HWY_INLINE std::size_t each_whole_vector(D tag, std::size_t i, std::size_t count, Run run) {
    for (const std::size_t n = hn::Lanes(tag); i + n <= count; i += n) {
        run(tag, i, n);
    }
    return i;
}

/// Calls run(tag, first, count) for whole vectors, ever narrower ones, then for a part of the
/// narrowest if masked loads do not fault. Partial wide vectors would stall on recent stores to the
/// memory behind them, and small pools lie close to each other. Returns the number of elements
/// processed.
template <typename Run>
HWY_INLINE std::size_t each_vector(std::size_t count, Run run) {
    constexpr hn::CappedTag<float, 4> d4;
    std::size_t i = each_whole_vector(d, 0, count, run);
    i = each_whole_vector(hn::CappedTag<float, 8>(), i, count, run);
    i = each_whole_vector(d4, i, count, run);
#if !HWY_MEM_OPS_MIGHT_FAULT
    if (i < count) {
        run(d4, i, count - i);
        i = count;
    }
#endif
    return i;
}

HWY_INLINE void move_axis(
    float* HWY_RESTRICT x, float* HWY_RESTRICT v, std::size_t count, float push, float air,
    const ParticleStep& step) {
    const float old_dt = step.old_dt();
    const float new_dt = step.new_dt();
    const float keep = step.keep;
    each_vector(count, [=](auto tag, std::size_t i, std::size_t n) HWY_ATTR {
        const auto old = load_part(tag, v + i, n);
        const auto relative = hn::Sub(hn::Add(old, hn::Set(tag, push)), hn::Set(tag, air));
        const auto next = hn::Add(hn::Set(tag, air), hn::Mul(relative, hn::Set(tag, keep)));
        store_part(tag, next, v + i, n);
        const auto moved =
            hn::Add(hn::Mul(old, hn::Set(tag, old_dt)), hn::Mul(next, hn::Set(tag, new_dt)));
        store_part(tag, hn::Add(load_part(tag, x + i, n), moved), x + i, n);
    });
}

/// One axis after another: arrays that begin at the same offset in a page, as large ones do, would
/// evict each other from the cache if all were walked at once.
std::size_t
move_particles_vector(const ParticleBlock& b, const ParticleStep& step, std::size_t& dead) {
    const Vec3 push = step.gravity * step.dt;
    move_axis(b.x, b.vx, b.count, push.x, step.air.x, step);
    move_axis(b.y, b.vy, b.count, push.y, step.air.y, step);
    move_axis(b.z, b.vz, b.count, push.z, step.air.z, step);
    std::size_t found = 0;
    const std::size_t done =
        each_vector(b.count, [&](auto tag, std::size_t i, std::size_t n) HWY_ATTR {
            const auto age = hn::Add(load_part(tag, b.age + i, n), hn::Set(tag, step.dt));
            store_part(tag, age, b.age + i, n);
            const auto old = hn::Ge(age, load_part(tag, b.life + i, n));
            // Lanes beyond the end do not count.
            found +=
                hn::CountTrue(tag, n < hn::Lanes(tag) ? hn::And(old, hn::FirstN(tag, n)) : old);
        });
    dead += found;
    return done;
}

/// -2^31 .. 2^31 of a lattice point, from the products of its coordinates with the multipliers.
HWY_INLINE V lattice_value(U x, U y, U z) {
    U h = hn::Xor3(x, y, z);
    h = hn::Mul(hn::Xor(h, hn::ShiftRight<15>(h)), hn::Set(du, particles::kHashMix));
    h = hn::Xor3(h, hn::ShiftRight<13>(h), hn::Set(du, 0x80000000u));
    return hn::ConvertTo(d, hn::BitCast(di, h));
}

/// Along an axis: the lattice points below and above, times the multiplier; the quintic weight of
/// the upper one, and a thirtieth of the derivative of that.
struct Axis {
    U low, high;
    V weight, slope;
};
HWY_INLINE Axis axis_at(V coordinate, std::uint32_t multiplier) {
    const V cell = hn::Floor(coordinate);
    const V t = hn::Sub(coordinate, cell);
    const U step = hn::Set(du, multiplier);
    const U moved = hn::BitCast(du, hn::Add(cell, hn::Set(d, particles::kWhole)));
    const U low = hn::Mul(hn::Sub(moved, hn::Set(du, particles::kWholeBits)), step);
    const V inner = hn::Add(
        hn::Mul(t, hn::Sub(hn::Mul(t, hn::Set(d, 6.0f)), hn::Set(d, 15.0f))), hn::Set(d, 10.0f));
    const V t2 = hn::Mul(t, t);
    const V hill = hn::Sub(t2, t);
    return {low, hn::Add(low, step), hn::Mul(hn::Mul(t2, t), inner), hn::Mul(hill, hill)};
}

struct Gradient {
    V x, y, z;
};
/// As raw_gradient below.
HWY_INLINE Gradient raw_gradient(V px, V py, V pz, std::uint32_t seed) {
    const Axis x = axis_at(px, particles::kHashX);
    const Axis y = axis_at(py, particles::kHashY);
    const Axis z = axis_at(pz, particles::kHashZ);
    const U x0 = hn::Xor(x.low, hn::Set(du, seed));
    const U x1 = hn::Xor(x.high, hn::Set(du, seed));
    const V v000 = lattice_value(x0, y.low, z.low);
    const V v100 = lattice_value(x1, y.low, z.low);
    const V v010 = lattice_value(x0, y.high, z.low);
    const V v110 = lattice_value(x1, y.high, z.low);
    const V v001 = lattice_value(x0, y.low, z.high);
    const V v101 = lattice_value(x1, y.low, z.high);
    const V v011 = lattice_value(x0, y.high, z.high);
    const V v111 = lattice_value(x1, y.high, z.high);
    const V along_x = hn::Sub(v100, v000);
    const V along_y = hn::Sub(v010, v000);
    const V along_z = hn::Sub(v001, v000);
    const V behind_x = hn::Sub(v101, v001);
    const V xy = hn::Sub(hn::Sub(v110, v010), along_x);
    const V xz = hn::Sub(behind_x, along_x);
    const V yz = hn::Sub(hn::Sub(v011, v001), along_y);
    const V xyz = hn::Sub(hn::Sub(hn::Sub(v111, v011), behind_x), xy);
    const V yz_at_x = hn::Add(yz, hn::Mul(xyz, x.weight));
    const V xz_at_y = hn::Add(xz, hn::Mul(xyz, y.weight));
    const auto sum = [](V a, V b, V wb, V c, V wc)
                         HWY_ATTR { return hn::Add(hn::Add(a, hn::Mul(b, wb)), hn::Mul(c, wc)); };
    return {
        hn::Mul(sum(along_x, xy, y.weight, xz_at_y, z.weight), x.slope),
        hn::Mul(sum(along_y, xy, x.weight, yz_at_x, z.weight), y.slope),
        hn::Mul(sum(along_z, xz, x.weight, yz_at_x, y.weight), z.slope)};
}

HWY_INLINE void add_to(float* HWY_RESTRICT v, V push) {
    hn::StoreU(hn::Add(hn::LoadU(d, v), push), d, v);
}
HWY_INLINE V cross_axis(V ay, V az, V by, V bz) {
    return hn::Sub(hn::Mul(ay, bz), hn::Mul(az, by));
}

std::size_t apply_turbulence_vector(const ParticleBlock& b, const Turbulence& t, float dt) {
    const std::size_t n = hn::Lanes(d);
    const V per_size = hn::Set(d, 1.0f / t.size);
    const V scale = hn::Set(d, particles::raw_curl_scale(t) * dt);
    const auto scaled = [&](const float* x, float drift) {
        return hn::Add(hn::Mul(hn::LoadU(d, x), per_size), hn::Set(d, drift));
    };
    std::size_t i = 0;
    for (; i + n <= b.count; i += n) {
        const Gradient p = raw_gradient(
            scaled(b.x + i, t.drift_a.x), scaled(b.y + i, t.drift_a.y),
            scaled(b.z + i, t.drift_a.z), t.seed);
        const Gradient q = raw_gradient(
            scaled(b.x + i, t.drift_b.x), scaled(b.y + i, t.drift_b.y),
            scaled(b.z + i, t.drift_b.z), t.seed ^ particles::kSeedB);
        add_to(b.vx + i, hn::Mul(cross_axis(p.y, p.z, q.y, q.z), scale));
        add_to(b.vy + i, hn::Mul(cross_axis(p.z, p.x, q.z, q.x), scale));
        add_to(b.vz + i, hn::Mul(cross_axis(p.x, p.y, q.x, q.y), scale));
    }
    return i;
}

std::size_t wrap_axis_vector(float* x, std::size_t count, float center, float size) {
    const std::size_t n = hn::Lanes(d);
    const V origin = hn::Set(d, center);
    const V extent = hn::Set(d, size);
    const V per_size = hn::Set(d, 1.0f / size);
    const V half = hn::Set(d, 0.5f);
    std::size_t i = 0;
    for (; i + n <= count; i += n) {
        const V old = hn::LoadU(d, x + i);
        const V turns = hn::Floor(hn::Add(hn::Mul(hn::Sub(old, origin), per_size), half));
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
HWY_EXPORT(apply_turbulence_vector);
HWY_EXPORT(wrap_axis_vector);

namespace {

float lattice_value(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    std::uint32_t h = x ^ y ^ z;
    h = (h ^ (h >> 15)) * particles::kHashMix;
    h ^= h >> 13;
    return static_cast<float>(static_cast<std::int32_t>(h ^ 0x80000000u));
}

struct Axis {
    std::uint32_t low, high;
    float weight, slope;
};
Axis axis_at(float coordinate, std::uint32_t multiplier) {
    const float cell = std::floor(coordinate);
    const float t = coordinate - cell;
    const auto moved = std::bit_cast<std::uint32_t>(cell + particles::kWhole);
    const std::uint32_t low = (moved - particles::kWholeBits) * multiplier;
    const float t2 = t * t;
    const float hill = t2 - t;
    return {low, low + multiplier, t2 * t * (t * (t * 6.0f - 15.0f) + 10.0f), hill * hill};
}

/// The gradient of noise_gradient() without its factor kRawUnit: values are -2^31 .. 2^31, slopes
/// (t^2 - t)^2 instead of 30 times that. The interpolated value is a sum of products of weights,
///
///     v000 + x wx + y wy + z wz + xy wx wy + xz wx wz + yz wy wz + xyz wx wy wz
///
/// whose derivatives need no value (Quilez, "Value noise derivatives", 2008).
Vec3 raw_gradient(const Vec3& at, std::uint32_t seed) {
    const Axis x = axis_at(at.x, particles::kHashX);
    const Axis y = axis_at(at.y, particles::kHashY);
    const Axis z = axis_at(at.z, particles::kHashZ);
    const std::uint32_t x0 = x.low ^ seed;
    const std::uint32_t x1 = x.high ^ seed;
    const float v000 = lattice_value(x0, y.low, z.low);
    const float v100 = lattice_value(x1, y.low, z.low);
    const float v010 = lattice_value(x0, y.high, z.low);
    const float v110 = lattice_value(x1, y.high, z.low);
    const float v001 = lattice_value(x0, y.low, z.high);
    const float v101 = lattice_value(x1, y.low, z.high);
    const float v011 = lattice_value(x0, y.high, z.high);
    const float v111 = lattice_value(x1, y.high, z.high);
    const float along_x = v100 - v000;
    const float along_y = v010 - v000;
    const float along_z = v001 - v000;
    const float behind_x = v101 - v001;
    const float xy = v110 - v010 - along_x;
    const float xz = behind_x - along_x;
    const float yz = v011 - v001 - along_y;
    const float xyz = v111 - v011 - behind_x - xy;
    const float yz_at_x = yz + xyz * x.weight;
    const float xz_at_y = xz + xyz * y.weight;
    return {
        (along_x + xy * y.weight + xz_at_y * z.weight) * x.slope,
        (along_y + xy * x.weight + yz_at_x * z.weight) * y.slope,
        (along_z + xz * x.weight + yz_at_x * y.weight) * z.slope};
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
    float* const positions[] = {b.x, b.y, b.z};
    float* const speeds[] = {b.vx, b.vy, b.vz};
    for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < b.count; ++i) {
            const float old = speeds[axis][i];
            const float next = step.air[axis] + (old + push[axis] - step.air[axis]) * step.keep;
            speeds[axis][i] = next;
            positions[axis][i] = positions[axis][i] + (old * step.old_dt() + next * step.new_dt());
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
    return done == block.count ? dead : dead + move_particles_scalar(block.from(done), step);
}

Vec3 noise_gradient(const Vec3& at, std::uint32_t seed) {
    return raw_gradient(at, seed) * particles::kRawUnit;
}

namespace {

/// Of two raw gradients.
Vec3 raw_curl(const Vec3& at, const Turbulence& t) {
    const Vec3 scaled = at * (1.0f / t.size);
    const Vec3 p = raw_gradient(scaled + t.drift_a, t.seed);
    const Vec3 q = raw_gradient(scaled + t.drift_b, t.seed ^ particles::kSeedB);
    return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

}  // namespace

Vec3 curl_noise(const Vec3& at, const Turbulence& turbulence) {
    return raw_curl(at, turbulence) * particles::raw_curl_scale(turbulence);
}

void apply_turbulence_scalar(const ParticleBlock& b, const Turbulence& turbulence, float dt) {
    const float scale = particles::raw_curl_scale(turbulence) * dt;
    for (std::size_t i = 0; i < b.count; ++i) {
        const Vec3 push = raw_curl({b.x[i], b.y[i], b.z[i]}, turbulence) * scale;
        b.vx[i] += push.x;
        b.vy[i] += push.y;
        b.vz[i] += push.z;
    }
}

void apply_turbulence(const ParticleBlock& block, const Turbulence& turbulence, float dt) {
    const std::size_t done = HWY_DYNAMIC_DISPATCH(apply_turbulence_vector)(block, turbulence, dt);
    apply_turbulence_scalar(block.from(done), turbulence, dt);
}

void apply_vortex(const ParticleBlock& b, const Vortex& vortex, float dt) {
    const Vec3& a = vortex.axis;
    for (std::size_t i = 0; i < b.count; ++i) {
        const Vec3 offset = Vec3(b.x[i], b.y[i], b.z[i]) - vortex.origin;
        const float along = offset.x * a.x + offset.y * a.y + offset.z * a.z;
        const Vec3 out = offset - along * a;
        const float length2 = out.x * out.x + out.y * out.y + out.z * out.z;
        const float scale = length2 > 0 ? dt / std::sqrt(length2) : 0.0f;
        const Vec3 tangent = {
            a.y * out.z - a.z * out.y, a.z * out.x - a.x * out.z, a.x * out.y - a.y * out.x};
        b.vx[i] += scale * (vortex.around * tangent.x - vortex.toward * out.x);
        b.vy[i] += scale * (vortex.around * tangent.y - vortex.toward * out.y);
        b.vz[i] += scale * (vortex.around * tangent.z - vortex.toward * out.z);
    }
}

void apply_steering(const ParticleBlock& b, const Steering& steering) {
    const Vec3& a = steering.axis;
    for (std::size_t i = 0; i < b.count; ++i) {
        const Vec3 velocity = {b.vx[i], b.vy[i], b.vz[i]};
        const float speed =
            std::sqrt(velocity.x * velocity.x + velocity.y * velocity.y + velocity.z * velocity.z);
        const Vec3 offset = Vec3(b.x[i], b.y[i], b.z[i]) - steering.origin;
        const Vec3 tangent = {
            a.y * offset.z - a.z * offset.y, a.z * offset.x - a.x * offset.z,
            a.x * offset.y - a.y * offset.x};
        const float radius =
            std::sqrt(tangent.x * tangent.x + tangent.y * tangent.y + tangent.z * tangent.z);
        const float orbit = radius > 0 ? steering.orbit : 0.0f;
        const float left = std::max(speed - steering.loss, 0.0f);
        const float along = speed > 0 ? (1.0f - orbit) * left / speed : 0.0f;
        const float around = radius > 0 ? orbit * left / radius : 0.0f;
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
    float* const positions[] = {b.x, b.y, b.z};
    for (int axis = 0; axis < 3; ++axis) {
        if (size[axis] > 0 && std::isfinite(center[axis])) {
            wrap_axis(positions[axis], b.count, center[axis], size[axis]);
        }
    }
}

void wrap_particles(const ParticleBlock& b, const Vec3& center, const Vec3& size) {
    float* const positions[] = {b.x, b.y, b.z};
    for (int axis = 0; axis < 3; ++axis) {
        if (size[axis] > 0 && std::isfinite(center[axis])) {
            const std::size_t done = HWY_DYNAMIC_DISPATCH(wrap_axis_vector)(
                positions[axis], b.count, center[axis], size[axis]);
            wrap_axis(positions[axis] + done, b.count - done, center[axis], size[axis]);
        }
    }
}

}  // namespace limn
#endif  // HWY_ONCE
