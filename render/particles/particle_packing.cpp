#include "render/particles/particle_packing.h"

#include <glm/packing.hpp>

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/particles/particle_packing.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {

// Packs from `first` on until a particle is not born yet; returns how many it has packed.

#if HWY_TARGET == HWY_SCALAR  // no SIMD

std::size_t
pack_particles_vector(const ParticlePool&, const ParticlePacking&, std::size_t, ParticleInstance*) {
    return 0;
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Pairs = hn::ScalableTag<std::uint64_t>;  // an instance is three and a half of them
constexpr Pairs dp;
constexpr hn::Rebind<std::uint32_t, Pairs> dw;
constexpr hn::Rebind<std::int32_t, Pairs> di;
constexpr hn::Rebind<float, Pairs> df;
constexpr hn::Rebind<hwy::float16_t, Pairs> dh;
constexpr hn::Rebind<std::uint16_t, Pairs> dhw;
using F = hn::Vec<decltype(df)>;
using P = hn::Vec<Pairs>;

HWY_INLINE P low(F x) {
    return hn::PromoteTo(dp, hn::BitCast(dw, x));
}
HWY_INLINE P high(P x) {
    return hn::ShiftLeft<32>(x);
}
HWY_INLINE P half(F x) {
    return hn::PromoteTo(dp, hn::PromoteTo(dw, hn::BitCast(dhw, hn::DemoteTo(dh, x))));
}

std::size_t pack_particles_vector(
    const ParticlePool& pool, const ParticlePacking& packing, std::size_t first,
    ParticleInstance* out) {
    const std::size_t n = hn::Lanes(dp);
    const std::size_t count = pool.size();
    const F zero = hn::Zero(df);
    const F back = hn::Set(df, packing.back);
    const P look = hn::Set(dp, std::uint64_t{packing.look} << 48);
    std::size_t i = first;
    for (; i + n <= count; i += n, out += n) {
        const F age = hn::Sub(hn::LoadU(df, &pool.age[i]), back);
        if (!hn::AllFalse(df, hn::Lt(age, zero))) {
            break;
        }
        const F life = hn::Max(hn::LoadU(df, &pool.life[i]), hn::Set(df, 1e-6f));
        const F fraction = hn::Min(hn::Max(hn::Div(age, life), zero), hn::Set(df, 1.0f));
        const P steps = hn::PromoteTo(
            dp, hn::BitCast(dw, hn::ConvertTo(di, hn::Mul(fraction, hn::Set(df, 65535.0f)))));
        const F vx = hn::LoadU(df, &pool.vx[i]);
        const F vy = hn::LoadU(df, &pool.vy[i]);
        const F vz = hn::LoadU(df, &pool.vz[i]);
        const F x = hn::Sub(hn::LoadU(df, &pool.x[i]), hn::Mul(vx, back));
        const F y = hn::Sub(hn::LoadU(df, &pool.y[i]), hn::Mul(vy, back));
        const F z = hn::Sub(hn::LoadU(df, &pool.z[i]), hn::Mul(vz, back));
        const P moves = hn::Or(
            hn::Or(
                half(hn::Sub(vx, hn::Set(df, packing.observer.x))),
                hn::ShiftLeft<16>(half(hn::Sub(vy, hn::Set(df, packing.observer.y))))),
            hn::Or(
                high(half(hn::Sub(vz, hn::Set(df, packing.observer.z)))),
                hn::ShiftLeft<48>(half(age))));
        alignas(64) std::uint64_t wide[4 * hn::MaxLanes(dp)];
        hn::StoreInterleaved4(
            hn::Or(low(x), high(low(y))), hn::Or(hn::Or(low(z), high(steps)), look), moves,
            hn::PromoteTo(dp, hn::LoadU(dw, &pool.look[i])), dp, wide);
        for (std::size_t k = 0; k < n; ++k) {
            std::memcpy(static_cast<void*>(out + k), wide + 4 * k, sizeof(ParticleInstance));
        }
    }
    return i - first;
}

#endif

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {
namespace {

HWY_EXPORT(pack_particles_vector);

constexpr std::size_t kScalarRun = 64;  // particles packed one by one where one is not born yet

/// Appends those of [first, last) that are born; returns the new number of instances.
std::size_t pack_each(
    const ParticlePool& pool, const ParticlePacking& packing, std::size_t first, std::size_t last,
    std::size_t packed, std::span<ParticleInstance> out) {
    for (std::size_t i = first; i < last; ++i) {
        const float age = pool.age[i] - packing.back;
        if (age < 0) {
            continue;  // not born yet
        }
        const Vec3 velocity = {pool.vx[i], pool.vy[i], pool.vz[i]};
        const float fraction = std::min(std::max(age / std::max(pool.life[i], 1e-6f), 0.0f), 1.0f);
        out[packed++] = {
            .position = Vec3(pool.x[i], pool.y[i], pool.z[i]) - velocity * packing.back,
            .look_and_life = packing.look << 16 | static_cast<std::uint32_t>(fraction * 65535.0f),
            .velocity_xy = glm::packHalf2x16(Vec2(velocity) - Vec2(packing.observer)),
            .velocity_z_age = glm::packHalf2x16(Vec2(velocity.z - packing.observer.z, age)),
            .random = pool.look[i]};
    }
    return packed;
}

}  // namespace

Vec4 ParticleInstance::motion() const {
    return {glm::unpackHalf2x16(velocity_xy), glm::unpackHalf2x16(velocity_z_age)};
}

std::size_t pack_particles(
    const ParticlePool& pool, const ParticlePacking& packing, std::span<ParticleInstance> out) {
    std::size_t packed = 0;
    for (std::size_t i = 0; i < pool.size();) {
        const std::size_t run =
            HWY_DYNAMIC_DISPATCH(pack_particles_vector)(pool, packing, i, out.data() + packed);
        i += run;
        packed += run;
        const std::size_t last = std::min(i + kScalarRun, pool.size());
        packed = pack_each(pool, packing, i, last, packed, out);
        i = last;
    }
    return packed;
}

std::size_t pack_particles_scalar(
    const ParticlePool& pool, const ParticlePacking& packing, std::span<ParticleInstance> out) {
    return pack_each(pool, packing, 0, pool.size(), 0, out);
}

}  // namespace limn
#endif
