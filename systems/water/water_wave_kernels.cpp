#include "systems/water/water_wave_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/water/water_wave_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

// Techniques: water.gerstner, water.wave-sum

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

inline constexpr std::size_t kLinesAtOnce = 4;

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

bool sum_lines_vector(std::span<const WaveLine>, const Vec2&, WavePoint&) {
    return false;
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using V = hn::Vec<Floats>;
constexpr Floats d;
using Four = hn::FixedTag<float, waves::kLinesAtOnce>;
using V4 = hn::Vec<Four>;
constexpr Four d4;

template <typename V>
struct SinCos {
    V sin;
    V cos;
};

template <typename V>
HWY_INLINE SinCos<V> sin_cos(V angle) {
    constexpr hn::DFromV<V> dv;
    const V turns = hn::Round(hn::Mul(angle, hn::Set(dv, waves::kOverPi)));
    V x = hn::Sub(angle, hn::Mul(turns, hn::Set(dv, waves::kPi0)));
    x = hn::Sub(x, hn::Mul(turns, hn::Set(dv, waves::kPi1)));
    x = hn::Sub(x, hn::Mul(turns, hn::Set(dv, waves::kPi2)));
    // Odd half turns change the sign: 1 - 2 (turns - 2 round(turns / 2))^2.
    const V half = hn::Round(hn::Mul(turns, hn::Set(dv, 0.5f)));
    const V odd = hn::Sub(turns, hn::Add(half, half));
    const V sign = hn::Sub(hn::Set(dv, 1.0f), hn::Mul(hn::Set(dv, 2.0f), hn::Mul(odd, odd)));
    const V x2 = hn::Mul(x, x);
    V s = hn::Add(hn::Mul(hn::Set(dv, waves::kSin3), x2), hn::Set(dv, waves::kSin2));
    s = hn::Add(hn::Mul(s, x2), hn::Set(dv, waves::kSin1));
    s = hn::Add(hn::Mul(s, x2), hn::Set(dv, waves::kSin0));
    V c = hn::Add(hn::Mul(hn::Set(dv, waves::kCos4), x2), hn::Set(dv, waves::kCos3));
    c = hn::Add(hn::Mul(c, x2), hn::Set(dv, waves::kCos2));
    c = hn::Add(hn::Mul(c, x2), hn::Set(dv, waves::kCos1));
    c = hn::Add(hn::Mul(c, x2), hn::Set(dv, waves::kCos0));
    return {
        hn::Mul(sign, hn::Add(x, hn::Mul(x, hn::Mul(x2, s)))),
        hn::Mul(sign, hn::Add(hn::Set(dv, 1.0f), hn::Mul(x2, c)))};
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
            const SinCos<V> at = sin_cos(phase);
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

/// Numbers of up to four lines from `first` on; those that are not there move nothing.
struct FourLines {
    V4 kx, ky, side_x, side_y, phase, amplitude, lean, frequency;
};
HWY_INLINE FourLines load_lines(std::span<const WaveLine> lines, std::size_t first) {
    constexpr hn::RebindToSigned<Four> di;
    constexpr int kWords = sizeof(WaveLine) / sizeof(float);
    static_assert(sizeof(WaveLine) == 8 * sizeof(float));
    const auto lane = hn::Iota(di, 0);
    const auto left = hn::Set(di, static_cast<std::int32_t>(lines.size() - first));
    const auto is_there = hn::MaskFromVec(hn::BitCast(d4, hn::VecFromMask(di, hn::Lt(lane, left))));
    const auto index = hn::Mul(hn::Min(lane, hn::Sub(left, hn::Set(di, 1))), hn::Set(di, kWords));
    const float* const words = &lines[first].k.x;
    const auto word = [&](int i) { return hn::GatherIndex(d4, words + i, index); };
    return {
        word(0),
        word(1),
        hn::IfThenElseZero(is_there, word(2)),
        hn::IfThenElseZero(is_there, word(3)),
        word(4),
        hn::IfThenElseZero(is_there, word(5)),
        word(6),
        word(7)};
}

/// False where there are no vectors.
bool sum_lines_vector(std::span<const WaveLine> lines, const Vec2& at, WavePoint& point) {
    const V4 zero = hn::Zero(d4);
    const V4 one = hn::Set(d4, 1.0f);
    V4 ox = zero, oy = zero, oz = zero, xx = zero, xy = zero, xz = zero;
    V4 zx = zero, zy = zero, zz = zero, vx = zero, vy = zero, vz = zero;
    for (std::size_t first = 0; first < lines.size(); first += waves::kLinesAtOnce) {
        const FourLines line = load_lines(lines, first);
        const V4 phase = hn::Add(
            hn::Add(hn::Mul(line.kx, hn::Set(d4, at.x)), hn::Mul(line.ky, hn::Set(d4, at.y))),
            line.phase);
        const SinCos<V4> turn = sin_cos(phase);
        const V4 leaning = hn::IfThenElseZero(hn::Gt(turn.sin, zero), line.lean);
        SinCos<V4> moved = turn;
        if (!hn::AllTrue(d4, hn::Eq(line.lean, zero))) {
            moved = sin_cos(hn::Sub(phase, hn::Mul(leaning, turn.sin)));
        }
        // By phase.
        const V4 bx = hn::Mul(hn::Neg(line.side_x), turn.sin);
        const V4 by =
            hn::Mul(hn::Mul(line.amplitude, moved.cos), hn::Sub(one, hn::Mul(leaning, turn.cos)));
        const V4 bz = hn::Mul(hn::Neg(line.side_y), turn.sin);
        const V4 back = hn::Neg(line.frequency);
        ox = hn::Add(ox, hn::Mul(line.side_x, turn.cos));
        oy = hn::Add(oy, hn::Mul(line.amplitude, moved.sin));
        oz = hn::Add(oz, hn::Mul(line.side_y, turn.cos));
        xx = hn::Add(xx, hn::Mul(line.kx, bx));
        xy = hn::Add(xy, hn::Mul(line.kx, by));
        xz = hn::Add(xz, hn::Mul(line.kx, bz));
        zx = hn::Add(zx, hn::Mul(line.ky, bx));
        zy = hn::Add(zy, hn::Mul(line.ky, by));
        zz = hn::Add(zz, hn::Mul(line.ky, bz));
        vx = hn::Add(vx, hn::Mul(back, bx));
        vy = hn::Add(vy, hn::Mul(back, by));
        vz = hn::Add(vz, hn::Mul(back, bz));
    }
    const auto total = [&](V4 sum) {
        float lanes[waves::kLinesAtOnce];
        hn::StoreU(sum, d4, lanes);
        return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
    };
    point = {
        {total(ox), total(oy), total(oz)},
        {total(xx), total(xy), total(xz)},
        {total(zx), total(zy), total(zz)},
        {total(vx), total(vy), total(vz)}};
    return true;
}

#endif  // HWY_TARGET

}  // namespace
}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(sum_waves_vector);
HWY_EXPORT(sum_lines_vector);

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

WavePoint move_by_line(const WaveLine& line, const Vec2& at) {
    const float phase = (line.k.x * at.x + line.k.y * at.y) + line.phase;
    const ScalarSinCos turn = sin_cos(phase);
    const float leaning = turn.sin > 0 ? line.lean : 0.0f;
    const ScalarSinCos moved = sin_cos(phase - leaning * turn.sin);
    const Vec3 by_phase = {
        -line.side.x * turn.sin, (line.amplitude * moved.cos) * (1.0f - leaning * turn.cos),
        -line.side.y * turn.sin};
    return {
        {line.side.x * turn.cos, line.amplitude * moved.sin, line.side.y * turn.cos},
        line.k.x * by_phase,
        line.k.y * by_phase,
        -line.frequency * by_phase};
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

WavePoint& WavePoint::operator+=(const WavePoint& other) {
    offset += other.offset;
    by_x += other.by_x;
    by_z += other.by_z;
    velocity += other.velocity;
    return *this;
}

WavePoint sum_lines(std::span<const WaveLine> lines, const Vec2& at) {
    WavePoint sum;
    return HWY_DYNAMIC_DISPATCH(sum_lines_vector)(lines, at, sum) ? sum
                                                                  : sum_lines_scalar(lines, at);
}

WavePoint sum_lines_scalar(std::span<const WaveLine> lines, const Vec2& at) {
    WavePoint sums[waves::kLinesAtOnce];
    for (std::size_t i = 0; i < lines.size(); ++i) {
        sums[i % waves::kLinesAtOnce] += move_by_line(lines[i], at);
    }
    sums[0] += sums[1];
    sums[2] += sums[3];
    return sums[0] += sums[2];
}

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
