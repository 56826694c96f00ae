#include "systems/water/water_ripple_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/water/water_ripple_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {

/// Returns the number of cells processed; the scalar version handles the remainder.
std::size_t step_ripple_row_vector(
    const RippleRows& rows, std::span<float> before, const float* keep, float keep_row,
    float courant2) {
#if HWY_TARGET == HWY_SCALAR  // no vectors here
    (void)rows;
    (void)before;
    (void)keep;
    (void)keep_row;
    (void)courant2;
    return 0;
#else
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::ScalableTag<float> d;
    const std::size_t lanes = hn::Lanes(d);
    const auto four = hn::Set(d, 4.0f);
    const auto twenty = hn::Set(d, 20.0f);
    const auto factor = hn::Set(d, courant2 / 6.0f);
    const auto row_keep = hn::Set(d, keep_row);
    std::size_t x = 0;
    for (; x + lanes <= before.size(); x += lanes) {
        const float* n = rows.north + x;
        const float* h = rows.here + x;
        const float* s = rows.south + x;
        const auto center = hn::LoadU(d, h);
        const auto edges = hn::Add(
            hn::Add(hn::LoadU(d, n), hn::LoadU(d, s)),
            hn::Add(hn::LoadU(d, h - 1), hn::LoadU(d, h + 1)));
        const auto corners = hn::Add(
            hn::Add(hn::LoadU(d, n - 1), hn::LoadU(d, n + 1)),
            hn::Add(hn::LoadU(d, s - 1), hn::LoadU(d, s + 1)));
        const auto bend = hn::Sub(hn::Add(hn::Mul(four, edges), corners), hn::Mul(twenty, center));
        const auto gone = hn::Sub(center, hn::LoadU(d, before.data() + x));
        const auto kept = hn::Mul(hn::Mul(row_keep, hn::LoadU(d, keep + x)), gone);
        hn::StoreU(hn::Add(center, hn::Add(kept, hn::Mul(factor, bend))), d, before.data() + x);
    }
    return x;
#endif
}

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(step_ripple_row_vector);

namespace {

void step_cells(
    const RippleRows& rows, std::span<float> before, const float* keep, float keep_row,
    float courant2, std::size_t first) {
    const float factor = courant2 / 6.0f;
    for (std::size_t x = first; x < before.size(); ++x) {
        const float* n = rows.north + x;
        const float* h = rows.here + x;
        const float* s = rows.south + x;
        const float edges = (n[0] + s[0]) + (h[-1] + h[1]);
        const float corners = (n[-1] + n[1]) + (s[-1] + s[1]);
        const float bend = (4.0f * edges + corners) - 20.0f * h[0];
        const float kept = keep_row * keep[x] * (h[0] - before[x]);
        before[x] = h[0] + (kept + factor * bend);
    }
}

}  // namespace

void step_ripple_row(
    const RippleRows& rows, std::span<float> before, const float* keep, float keep_row,
    float courant2) {
    const std::size_t done =
        HWY_DYNAMIC_DISPATCH(step_ripple_row_vector)(rows, before, keep, keep_row, courant2);
    step_cells(rows, before, keep, keep_row, courant2, done);
}

void step_ripple_row_scalar(
    const RippleRows& rows, std::span<float> before, const float* keep, float keep_row,
    float courant2) {
    step_cells(rows, before, keep, keep_row, courant2, 0);
}

}  // namespace limn
#endif  // HWY_ONCE
