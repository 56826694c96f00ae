#include "systems/water/ocean_kernels.h"

#include "ecs/base/check.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/water/ocean_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
// Techniques: water.fft-synthesis

namespace limn::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <typename D>
struct SinCos {
    hn::Vec<D> sin;
    hn::Vec<D> cos;
};

/// Of an angle in full turns, -0.5 .. 0.5. Cephes polynomials (S. Moshier).
template <typename D>
HWY_INLINE SinCos<D> sin_cos_of_turns(D d, hn::Vec<D> turns) {
    using V = hn::Vec<D>;
    const V quarter = hn::Round(hn::Mul(turns, hn::Set(d, 4.0f)));  // -2 .. 2
    const V rest = hn::Sub(turns, hn::Mul(quarter, hn::Set(d, 0.25f)));
    const V x = hn::Mul(rest, hn::Set(d, 6.28318530718f));  // within a quarter turn of 0
    const V x2 = hn::Mul(x, x);
    const V s = hn::Add(
        hn::Mul(
            hn::Add(hn::Mul(hn::Set(d, -1.9515295891e-4f), x2), hn::Set(d, 8.3321608736e-3f)), x2),
        hn::Set(d, -1.6666654611e-1f));
    const V c = hn::Add(
        hn::Mul(
            hn::Add(
                hn::Mul(hn::Set(d, 2.443315711809948e-5f), x2), hn::Set(d, -1.388731625493765e-3f)),
            x2),
        hn::Set(d, 4.166664568298827e-2f));
    const V sin = hn::Add(hn::Mul(hn::Mul(s, x2), x), x);
    const V cos = hn::Add(
        hn::Sub(hn::Set(d, 1.0f), hn::Mul(hn::Set(d, 0.5f), x2)), hn::Mul(hn::Mul(c, x2), x2));

    const V one = hn::Set(d, 1.0f);
    const auto odd = hn::Eq(hn::Abs(quarter), one);
    const auto half = hn::Eq(hn::Abs(quarter), hn::Set(d, 2.0f));
    const V picked_sin = hn::IfThenElse(odd, cos, sin);
    const V picked_cos = hn::IfThenElse(odd, sin, cos);
    const auto sin_negative = hn::Or(half, hn::Eq(quarter, hn::Neg(one)));
    const auto cos_negative = hn::Or(half, hn::Eq(quarter, one));
    return {
        hn::IfThenElse(sin_negative, hn::Neg(picked_sin), picked_sin),
        hn::IfThenElse(cos_negative, hn::Neg(picked_cos), picked_cos)};
}

/// `Doubles` determines the number of lanes; phases need double precision.
template <typename Doubles>
void evolve(
    Doubles dd, const OceanCascade& cascade, float choppiness, double time,
    std::size_t first_column, float* pairs) {
    using D = hn::Rebind<float, Doubles>;
    using V = hn::Vec<D>;
    const D d;
    const std::size_t size = static_cast<std::size_t>(cascade.size);
    const std::size_t plane = kFftColumns * size;
    const auto time_in_periods = hn::Set(dd, time / 6.283185307179586);
    const V lambda = hn::Set(d, choppiness);
    const V zero = hn::Zero(d);
    const V one = hn::Set(d, 1.0f);

    for (std::size_t row = 0; row < size; ++row) {
        const V kx = hn::Set(d, cascade.axis[row]);
        for (std::size_t column = 0; column < kFftColumns; column += hn::Lanes(d)) {
            const std::size_t at = row * size + first_column + column;
            const auto frequency = hn::PromoteTo(dd, hn::LoadU(d, &cascade.frequency[at]));
            const auto turns = hn::Mul(frequency, time_in_periods);
            const SinCos<D> phase =
                sin_cos_of_turns(d, hn::DemoteTo(d, hn::Sub(turns, hn::Round(turns))));
            const V ahead_re = hn::LoadU(d, &cascade.ahead_re[at]);
            const V ahead_im = hn::LoadU(d, &cascade.ahead_im[at]);
            const V behind_re = hn::LoadU(d, &cascade.behind_re[at]);
            const V behind_im = hn::LoadU(d, &cascade.behind_im[at]);
            const V h_re = hn::Add(
                hn::Mul(hn::Add(ahead_re, behind_re), phase.cos),
                hn::Mul(hn::Sub(ahead_im, behind_im), phase.sin));
            const V h_im = hn::Add(
                hn::Mul(hn::Add(ahead_im, behind_im), phase.cos),
                hn::Mul(hn::Sub(behind_re, ahead_re), phase.sin));

            const V kz = hn::LoadU(d, &cascade.axis[first_column + column]);
            const V k2 = hn::Add(hn::Mul(kx, kx), hn::Mul(kz, kz));
            const V inverse = hn::IfThenElse(hn::Gt(k2, zero), hn::Div(one, hn::Sqrt(k2)), zero);
            const V push_x = hn::Mul(lambda, hn::Mul(kx, inverse));
            const V push_z = hn::Mul(lambda, hn::Mul(kz, inverse));
            // Spectra of a: h, -kx push_x h, -kz push_z h, -kx push_z h;
            // of b: i push_x h, i kx h, i kz h, i push_z h.
            const V factors[kOceanPairs] = {
                hn::Sub(one, push_x), hn::Neg(hn::Add(hn::Mul(kx, push_x), kx)),
                hn::Neg(hn::Add(hn::Mul(kz, push_z), kz)),
                hn::Neg(hn::Add(hn::Mul(kx, push_z), push_z))};
            for (std::size_t pair = 0; pair < kOceanPairs; ++pair) {
                float* to = pairs + pair * 2 * plane + row * kFftColumns + column;
                hn::StoreU(hn::Mul(h_re, factors[pair]), d, to);
                hn::StoreU(hn::Mul(h_im, factors[pair]), d, to + plane);
            }
        }
    }
}

template <typename D>
std::size_t foam(
    D d, const ShiftDerivatives& shift, float threshold, float gain, float fade, float* coverage,
    std::size_t begin, std::size_t end) {
    using V = hn::Vec<D>;
    const V one = hn::Set(d, 1.0f);
    std::size_t i = begin;
    for (; i + hn::Lanes(d) <= end; i += hn::Lanes(d)) {
        const V xx = hn::Add(one, hn::LoadU(d, &shift.xx[i]));
        const V zz = hn::Add(one, hn::LoadU(d, &shift.zz[i]));
        const V xz = hn::LoadU(d, &shift.xz[i]);
        const V left = hn::Sub(hn::Mul(xx, zz), hn::Mul(xz, xz));
        const V growth =
            hn::Mul(hn::Set(d, gain), hn::Max(hn::Sub(hn::Set(d, threshold), left), hn::Zero(d)));
        const V grown = hn::Div(hn::Add(hn::LoadU(d, coverage + i), growth), hn::Add(one, growth));
        hn::StoreU(hn::Mul(grown, hn::Set(d, fade)), d, coverage + i);
    }
    return i;
}

using WideDoubles = hn::CappedTag<double, kFftColumns>;
using OneDouble = hn::FixedTag<double, 1>;

void evolve_vector(
    const OceanCascade& cascade, float choppiness, double time, std::size_t first_column,
    float* pairs) {
    evolve(WideDoubles(), cascade, choppiness, time, first_column, pairs);
}

void evolve_one_lane(
    const OceanCascade& cascade, float choppiness, double time, std::size_t first_column,
    float* pairs) {
    evolve(OneDouble(), cascade, choppiness, time, first_column, pairs);
}

std::size_t foam_vector(
    const ShiftDerivatives& shift, float threshold, float gain, float fade, float* coverage,
    std::size_t begin, std::size_t end) {
    return foam(hn::ScalableTag<float>(), shift, threshold, gain, fade, coverage, begin, end);
}

std::size_t foam_one_lane(
    const ShiftDerivatives& shift, float threshold, float gain, float fade, float* coverage,
    std::size_t begin, std::size_t end) {
    return foam(hn::FixedTag<float, 1>(), shift, threshold, gain, fade, coverage, begin, end);
}

}  // namespace
}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(evolve_vector);
HWY_EXPORT(foam_vector);

namespace {

void check_columns(
    const OceanCascade& cascade, std::size_t first_column, std::span<const float> pairs) {
    const std::size_t size = static_cast<std::size_t>(cascade.size);
    LIMN_CHECK(first_column + kFftColumns <= size);
    LIMN_CHECK(pairs.size() >= kOceanPairs * 2 * kFftColumns * size);
    LIMN_CHECK(cascade.frequency.size() == size * size && cascade.axis.size() == size);
}

}  // namespace

void evolve_waves(
    const OceanCascade& cascade, float choppiness, double time, std::size_t first_column,
    std::span<float> pairs) {
    check_columns(cascade, first_column, pairs);
    HWY_DYNAMIC_DISPATCH(evolve_vector)(cascade, choppiness, time, first_column, pairs.data());
}

void evolve_waves_scalar(
    const OceanCascade& cascade, float choppiness, double time, std::size_t first_column,
    std::span<float> pairs) {
    check_columns(cascade, first_column, pairs);
    HWY_STATIC_DISPATCH(evolve_one_lane)(cascade, choppiness, time, first_column, pairs.data());
}

void step_foam(
    const ShiftDerivatives& shift, float threshold, float gain, float fade,
    std::span<float> coverage, std::size_t begin, std::size_t end) {
    LIMN_CHECK(
        end <= coverage.size() && end <= shift.xx.size() && end <= shift.zz.size()
        && end <= shift.xz.size());
    const std::size_t done = HWY_DYNAMIC_DISPATCH(foam_vector)(
        shift, threshold, gain, fade, coverage.data(), begin, end);
    step_foam_scalar(shift, threshold, gain, fade, coverage, done, end);
}

void step_foam_scalar(
    const ShiftDerivatives& shift, float threshold, float gain, float fade,
    std::span<float> coverage, std::size_t begin, std::size_t end) {
    LIMN_CHECK(
        end <= coverage.size() && end <= shift.xx.size() && end <= shift.zz.size()
        && end <= shift.xz.size());
    HWY_STATIC_DISPATCH(foam_one_lane)
    (shift, threshold, gain, fade, coverage.data(), begin, end);
}

}  // namespace limn
#endif  // HWY_ONCE
