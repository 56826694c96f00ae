#include "systems/water/water_wave_kernels.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/water/water_wave_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

#ifndef LIMN_WATER_WAVE_CONSTANTS
#define LIMN_WATER_WAVE_CONSTANTS
namespace limn::waves {

// Pi in three parts, the first two with few bits, for range reduction (Cody and Waite 1980).
inline constexpr float kOverPi = 0.318309886183790672f;
inline constexpr float kPi0 = 3.140625f;
inline constexpr float kPi1 = 0.0009670257568359375f;
inline constexpr float kPi2 = 6.277114152908325e-7f;

// sin x = x + x^3 (s0 + s1 x^2 + s2 x^4 + s3 x^6) and cos x = 1 + x^2 (c0 + c1 x^2 + c2 x^4 + c3
// x^6 + c4 x^8) for |x| <= pi/2, off by at most 4e-8 and 1e-8.
inline constexpr float kSin0 = -1.6666654e-1f;
inline constexpr float kSin1 = 8.3323948e-3f;
inline constexpr float kSin2 = -1.9803327e-4f;
inline constexpr float kSin3 = 2.5967256e-6f;
inline constexpr float kCos0 = -0.5f;
inline constexpr float kCos1 = 4.16666418e-2f;
inline constexpr float kCos2 = -1.38883683e-3f;
inline constexpr float kCos3 = 2.47604892e-5f;
inline constexpr float kCos4 = -2.60518434e-7f;

}  // namespace limn::waves
#endif

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR  // no vectors here

std::size_t sum_waves_vector(
    std::span<const WaveLine>, std::span<const float>, std::span<const float>, const WaveOffsets&) {
    return 0;
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using V = hn::Vec<Floats>;
constexpr Floats d;

struct SinCos {
    V sin;
    V cos;
};

HWY_INLINE SinCos sin_cos(V angle) {
    const V turns = hn::Round(hn::Mul(angle, hn::Set(d, waves::kOverPi)));
    V x = hn::Sub(angle, hn::Mul(turns, hn::Set(d, waves::kPi0)));
    x = hn::Sub(x, hn::Mul(turns, hn::Set(d, waves::kPi1)));
    x = hn::Sub(x, hn::Mul(turns, hn::Set(d, waves::kPi2)));
    // Odd half turns change the sign: 1 - 2 (turns - 2 round(turns / 2))^2.
    const V half = hn::Round(hn::Mul(turns, hn::Set(d, 0.5f)));
    const V odd = hn::Sub(turns, hn::Add(half, half));
    const V sign = hn::Sub(hn::Set(d, 1.0f), hn::Mul(hn::Set(d, 2.0f), hn::Mul(odd, odd)));
    const V x2 = hn::Mul(x, x);
    V s = hn::Add(hn::Mul(hn::Set(d, waves::kSin3), x2), hn::Set(d, waves::kSin2));
    s = hn::Add(hn::Mul(s, x2), hn::Set(d, waves::kSin1));
    s = hn::Add(hn::Mul(s, x2), hn::Set(d, waves::kSin0));
    V c = hn::Add(hn::Mul(hn::Set(d, waves::kCos4), x2), hn::Set(d, waves::kCos3));
    c = hn::Add(hn::Mul(c, x2), hn::Set(d, waves::kCos2));
    c = hn::Add(hn::Mul(c, x2), hn::Set(d, waves::kCos1));
    c = hn::Add(hn::Mul(c, x2), hn::Set(d, waves::kCos0));
    return {
        hn::Mul(sign, hn::Add(x, hn::Mul(x, hn::Mul(x2, s)))),
        hn::Mul(sign, hn::Add(hn::Set(d, 1.0f), hn::Mul(x2, c)))};
}

/// Returns the number of points processed; the scalar version handles the remainder.
std::size_t sum_waves_vector(
    std::span<const WaveLine> lines, std::span<const float> x, std::span<const float> z,
    const WaveOffsets& offsets) {
    const std::size_t lanes = hn::Lanes(d);
    const V zero = hn::Zero(d);
    std::size_t i = 0;
    for (; i + lanes <= x.size(); i += lanes) {
        const V px = hn::LoadU(d, x.data() + i);
        const V pz = hn::LoadU(d, z.data() + i);
        V sum_x = zero;
        V sum_y = zero;
        V sum_z = zero;
        for (const WaveLine& line : lines) {
            const V phase = hn::Add(
                hn::Add(hn::Mul(hn::Set(d, line.k.x), px), hn::Mul(hn::Set(d, line.k.y), pz)),
                hn::Set(d, line.phase));
            const SinCos at = sin_cos(phase);
            V height = at.sin;
            if (line.lean > 0) {
                const V ahead = hn::Mul(hn::Set(d, line.lean), hn::Max(at.sin, zero));
                height = sin_cos(hn::Sub(phase, ahead)).sin;
            }
            sum_x = hn::Add(sum_x, hn::Mul(hn::Set(d, line.side.x), at.cos));
            sum_y = hn::Add(sum_y, hn::Mul(hn::Set(d, line.amplitude), height));
            sum_z = hn::Add(sum_z, hn::Mul(hn::Set(d, line.side.y), at.cos));
        }
        hn::StoreU(sum_x, d, offsets.x.data() + i);
        hn::StoreU(sum_y, d, offsets.height.data() + i);
        hn::StoreU(sum_z, d, offsets.z.data() + i);
    }
    return i;
}

#endif  // HWY_TARGET

}  // namespace
}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(sum_waves_vector);

namespace {

struct ScalarSinCos {
    float sin = 0;
    float cos = 0;
};

ScalarSinCos sin_cos(float angle) {
    const float turns = std::nearbyint(angle * waves::kOverPi);
    float x = angle - turns * waves::kPi0;
    x = x - turns * waves::kPi1;
    x = x - turns * waves::kPi2;
    const float half = std::nearbyint(turns * 0.5f);
    const float odd = turns - (half + half);
    const float sign = 1.0f - 2.0f * (odd * odd);
    const float x2 = x * x;
    float s = waves::kSin3 * x2 + waves::kSin2;
    s = s * x2 + waves::kSin1;
    s = s * x2 + waves::kSin0;
    float c = waves::kCos4 * x2 + waves::kCos3;
    c = c * x2 + waves::kCos2;
    c = c * x2 + waves::kCos1;
    c = c * x2 + waves::kCos0;
    return {sign * (x + x * (x2 * s)), sign * (1.0f + x2 * c)};
}

void sum_from(
    std::span<const WaveLine> lines, std::span<const float> x, std::span<const float> z,
    const WaveOffsets& offsets, std::size_t first) {
    for (std::size_t i = first; i < x.size(); ++i) {
        Vec3 sum(0);
        for (const WaveLine& line : lines) {
            const float phase = (line.k.x * x[i] + line.k.y * z[i]) + line.phase;
            const ScalarSinCos at = sin_cos(phase);
            float height = at.sin;
            if (line.lean > 0) {
                height = sin_cos(phase - line.lean * (at.sin > 0 ? at.sin : 0.0f)).sin;
            }
            sum.x += line.side.x * at.cos;
            sum.y += line.amplitude * height;
            sum.z += line.side.y * at.cos;
        }
        offsets.x[i] = sum.x;
        offsets.height[i] = sum.y;
        offsets.z[i] = sum.z;
    }
}

}  // namespace

void sum_waves(
    std::span<const WaveLine> lines, std::span<const float> x, std::span<const float> z,
    const WaveOffsets& offsets) {
    sum_from(lines, x, z, offsets, HWY_DYNAMIC_DISPATCH(sum_waves_vector)(lines, x, z, offsets));
}

void sum_waves_scalar(
    std::span<const WaveLine> lines, std::span<const float> x, std::span<const float> z,
    const WaveOffsets& offsets) {
    sum_from(lines, x, z, offsets, 0);
}

}  // namespace limn
#endif  // HWY_ONCE
