#include "systems/animation/pose_kernels.h"

#include "ecs/base/check.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/animation/pose_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

// Quaternions are read and written as x y z w.
static_assert(sizeof(limn::Quat) == 4 * sizeof(float));

// Techniques: char.pose-eval

#ifndef LIMN_POSE_CONSTANTS
#define LIMN_POSE_CONSTANTS
namespace limn::pose {

// acos x = sqrt(1 - x) (a0 + a1 x + ... + a7 x^7), 0 <= x <= 1, error at most 2e-8 (Abramowitz and
// Stegun 4.4.46).
inline constexpr float kAcos[] = {1.5707963050f, -0.2145988016f, 0.0889789874f, -0.0501743046f,
                                  0.0308918810f, -0.0170881256f, 0.0066700901f, -0.0012624911f};
// sin x = x + x^3 (s0 + s1 x^2 + ...), 0 <= x <= pi / 2, the series up to x^9, error at most 4e-6
// at the end, where the other weight is 0.
inline constexpr float kSin[] = {-1.0f / 6, 1.0f / 120, -1.0f / 5040, 1.0f / 362880};
/// Below this, sin x = x, which avoids the ratio 0 / 0 [rad].
inline constexpr float kMinAngle = 1e-4f;

}  // namespace limn::pose
#endif

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {

// Returns the number of rotations processed; the scalar version handles the remainder.

#if HWY_TARGET == HWY_SCALAR  // no vectors here

std::size_t
slerp_rotations_vector(std::span<const Quat>, std::span<const Quat>, float, std::span<Quat>) {
    return 0;
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using V = hn::Vec<Floats>;
constexpr Floats d;

template <std::size_t N>
HWY_INLINE V polynomial(const float (&coefficients)[N], V x) {
    V sum = hn::Set(d, coefficients[N - 1]);
    for (std::size_t i = N - 1; i-- > 0;) {
        sum = hn::Add(hn::Mul(sum, x), hn::Set(d, coefficients[i]));
    }
    return sum;
}

HWY_INLINE V sine_of(V x) {
    const V x2 = hn::Mul(x, x);
    return hn::Add(hn::Mul(hn::Mul(polynomial(pose::kSin, x2), x2), x), x);
}

HWY_INLINE V dot(V ax, V ay, V az, V aw, V bx, V by, V bz, V bw) {
    return hn::Add(
        hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Add(hn::Mul(az, bz), hn::Mul(aw, bw)));
}

std::size_t slerp_rotations_vector(
    std::span<const Quat> from, std::span<const Quat> to, float u, std::span<Quat> out) {
    const std::size_t lanes = hn::Lanes(d);
    const V one = hn::Set(d, 1.0f);
    const V fraction_from = hn::Set(d, 1.0f - u);
    const V fraction_to = hn::Set(d, u);
    std::size_t first = 0;
    for (; first + lanes <= from.size(); first += lanes) {
        V ax;
        V ay;
        V az;
        V aw;
        V bx;
        V by;
        V bz;
        V bw;
        hn::LoadInterleaved4(d, reinterpret_cast<const float*>(&from[first]), ax, ay, az, aw);
        hn::LoadInterleaved4(d, reinterpret_cast<const float*>(&to[first]), bx, by, bz, bw);
        const V signed_cosine = dot(ax, ay, az, aw, bx, by, bz, bw);
        const V cosine = hn::Min(hn::Abs(signed_cosine), one);
        const V omega = hn::Max(
            hn::Mul(hn::Sqrt(hn::Sub(one, cosine)), polynomial(pose::kAcos, cosine)),
            hn::Set(d, pose::kMinAngle));
        const V weight_from = sine_of(hn::Mul(fraction_from, omega));
        const V weight_to = hn::CopySign(sine_of(hn::Mul(fraction_to, omega)), signed_cosine);
        const V x = hn::Add(hn::Mul(weight_from, ax), hn::Mul(weight_to, bx));
        const V y = hn::Add(hn::Mul(weight_from, ay), hn::Mul(weight_to, by));
        const V z = hn::Add(hn::Mul(weight_from, az), hn::Mul(weight_to, bz));
        const V w = hn::Add(hn::Mul(weight_from, aw), hn::Mul(weight_to, bw));
        const V unit = hn::Div(one, hn::Sqrt(dot(x, y, z, w, x, y, z, w)));
        hn::StoreInterleaved4(
            hn::Mul(x, unit), hn::Mul(y, unit), hn::Mul(z, unit), hn::Mul(w, unit), d,
            reinterpret_cast<float*>(&out[first]));
    }
    return first;
}

#endif  // HWY_TARGET

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(slerp_rotations_vector);

namespace {

template <std::size_t N>
float polynomial(const float (&coefficients)[N], float x) {
    float sum = coefficients[N - 1];
    for (std::size_t i = N - 1; i-- > 0;) {
        sum = sum * x + coefficients[i];
    }
    return sum;
}

float sine_of(float x) {
    const float x2 = x * x;
    return polynomial(pose::kSin, x2) * x2 * x + x;
}

float dot(const Quat& a, const Quat& b) {
    return (a.x * b.x + a.y * b.y) + (a.z * b.z + a.w * b.w);
}

}  // namespace

void slerp_rotations_scalar(
    std::span<const Quat> from, std::span<const Quat> to, float u, std::span<Quat> out) {
    for (std::size_t i = 0; i < from.size(); ++i) {
        const Quat a = from[i];
        const Quat b = to[i];
        const float signed_cosine = dot(a, b);
        const float cosine = std::min(std::abs(signed_cosine), 1.0f);
        const float omega =
            std::max(std::sqrt(1.0f - cosine) * polynomial(pose::kAcos, cosine), pose::kMinAngle);
        const float weight_from = sine_of((1.0f - u) * omega);
        const float weight_to = std::copysign(sine_of(u * omega), signed_cosine);
        const Quat sum(
            weight_from * a.w + weight_to * b.w, weight_from * a.x + weight_to * b.x,
            weight_from * a.y + weight_to * b.y, weight_from * a.z + weight_to * b.z);
        const float unit = 1.0f / std::sqrt(dot(sum, sum));
        out[i] = Quat(sum.w * unit, sum.x * unit, sum.y * unit, sum.z * unit);
    }
}

void slerp_rotations(
    std::span<const Quat> from, std::span<const Quat> to, float u, std::span<Quat> out) {
    LIMN_CHECK(from.size() == to.size() && from.size() == out.size());
    const std::size_t done = HWY_DYNAMIC_DISPATCH(slerp_rotations_vector)(from, to, u, out);
    slerp_rotations_scalar(from.subspan(done), to.subspan(done), u, out.subspan(done));
}

}  // namespace limn
#endif  // HWY_ONCE
