#include "systems/water/fft_kernels.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/water/fft_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
// Techniques: water.fft-synthesis

namespace limn::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// One complex number per lane.
template <typename D>
struct Complex {
    hn::Vec<D> re;
    hn::Vec<D> im;
};

template <typename D>
HWY_INLINE Complex<D> load(D d, const FftColumns& from, std::size_t row, std::size_t column) {
    const std::size_t at = row * from.pitch + column;
    return {hn::LoadU(d, from.re + at), hn::LoadU(d, from.im + at)};
}

template <typename D>
HWY_INLINE void
store(D d, const Complex<D>& z, const FftColumns& to, std::size_t row, std::size_t column) {
    const std::size_t at = row * to.pitch + column;
    hn::StoreU(z.re, d, to.re + at);
    hn::StoreU(z.im, d, to.im + at);
}

template <typename D>
HWY_INLINE Complex<D> add(const Complex<D>& a, const Complex<D>& b) {
    return {hn::Add(a.re, b.re), hn::Add(a.im, b.im)};
}
template <typename D>
HWY_INLINE Complex<D> subtract(const Complex<D>& a, const Complex<D>& b) {
    return {hn::Sub(a.re, b.re), hn::Sub(a.im, b.im)};
}
template <typename D>
HWY_INLINE Complex<D> add_turned(const Complex<D>& a, const Complex<D>& b) {  // a + i b
    return {hn::Sub(a.re, b.im), hn::Add(a.im, b.re)};
}
template <typename D>
HWY_INLINE Complex<D> subtract_turned(const Complex<D>& a, const Complex<D>& b) {  // a - i b
    return {hn::Add(a.re, b.im), hn::Sub(a.im, b.re)};
}
template <typename D>
HWY_INLINE Complex<D> multiply(const Complex<D>& a, const Complex<D>& b) {
    return {
        hn::Sub(hn::Mul(a.re, b.re), hn::Mul(a.im, b.im)),
        hn::Add(hn::Mul(a.re, b.im), hn::Mul(a.im, b.re))};
}

/// e^(2 pi i turn / size) in all lanes.
template <typename D>
HWY_INLINE Complex<D> unit_root(D d, const FftPlan& plan, std::size_t turn) {
    return {hn::Set(d, plan.cosines[turn]), hn::Set(d, plan.sines[turn])};
}

/// One radix-4 step: the columns are `stride` interleaved sequences of `length` each.
template <typename D>
void radix4_pass(
    D d, const FftPlan& plan, std::size_t length, std::size_t stride, const FftColumns& from,
    const FftColumns& to) {
    const std::size_t quarter = length / 4;
    for (std::size_t p = 0; p < quarter; ++p) {
        const Complex<D> root1 = unit_root(d, plan, p * stride);
        const Complex<D> root2 = unit_root(d, plan, 2 * p * stride);
        const Complex<D> root3 = unit_root(d, plan, 3 * p * stride);
        for (std::size_t q = 0; q < stride; ++q) {
            const std::size_t in = q + stride * p;
            const std::size_t out = q + stride * 4 * p;
            for (std::size_t c = 0; c < kFftColumns; c += hn::Lanes(d)) {
                const Complex<D> x0 = load(d, from, in, c);
                const Complex<D> x1 = load(d, from, in + stride * quarter, c);
                const Complex<D> x2 = load(d, from, in + stride * 2 * quarter, c);
                const Complex<D> x3 = load(d, from, in + stride * 3 * quarter, c);
                const Complex<D> even = add(x0, x2);
                const Complex<D> even_rest = subtract(x0, x2);
                const Complex<D> odd = add(x1, x3);
                const Complex<D> odd_rest = subtract(x1, x3);
                const Complex<D> y1 = add_turned(even_rest, odd_rest);
                const Complex<D> y3 = subtract_turned(even_rest, odd_rest);
                store(d, add(even, odd), to, out, c);
                store(d, multiply(y1, root1), to, out + stride, c);
                store(d, multiply(subtract(even, odd), root2), to, out + 2 * stride, c);
                store(d, multiply(y3, root3), to, out + 3 * stride, c);
            }
        }
    }
}

/// The final radix-2 step of sizes that are not a power of four.
template <typename D>
void radix2_pass(D d, std::size_t stride, const FftColumns& from, const FftColumns& to) {
    for (std::size_t q = 0; q < stride; ++q) {
        for (std::size_t c = 0; c < kFftColumns; c += hn::Lanes(d)) {
            const Complex<D> x0 = load(d, from, q, c);
            const Complex<D> x1 = load(d, from, q + stride, c);
            store(d, add(x0, x1), to, q, c);
            store(d, subtract(x0, x1), to, q + stride, c);
        }
    }
}

template <typename D>
void inverse_columns(
    D d, const FftPlan& plan, const FftColumns& from, const FftColumns& to, float* scratch) {
    const std::size_t plane = kFftColumns * plan.size;
    const FftColumns blocks[2] = {
        {scratch, scratch + plane, kFftColumns},
        {scratch + 2 * plane, scratch + 3 * plane, kFftColumns}};
    FftColumns read = from;
    std::size_t length = plan.size;
    std::size_t stride = 1;
    for (int pass = 0; length > 1; ++pass) {
        const FftColumns& write = length <= 4 ? to : blocks[pass % 2];
        if (length >= 4) {
            radix4_pass(d, plan, length, stride, read, write);
        } else {
            radix2_pass(d, stride, read, write);
        }
        read = write;
        length /= 4;  // 0 after the radix-2 step
        stride *= 4;
    }
}

/// The widest vectors of the machine, limited to the width of a block.
using WideFloats = hn::CappedTag<float, kFftColumns>;

void inverse_columns_vector(
    const FftPlan& plan, const FftColumns& from, const FftColumns& to, float* scratch) {
    inverse_columns(WideFloats(), plan, from, to, scratch);
}

void inverse_columns_one_lane(
    const FftPlan& plan, const FftColumns& from, const FftColumns& to, float* scratch) {
    inverse_columns(hn::FixedTag<float, 1>(), plan, from, to, scratch);
}

/// In 4 x 4 blocks.
void transpose_columns_vector(const float* block, std::size_t rows, float* to, std::size_t pitch) {
#if HWY_TARGET == HWY_SCALAR
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t column = 0; column < kFftColumns; ++column) {
            to[column * pitch + row] = block[row * kFftColumns + column];
        }
    }
#else
    const hn::FixedTag<float, 4> d;
    const hn::Repartition<double, decltype(d)> pairs;
    for (std::size_t row = 0; row < rows; row += 4) {
        for (std::size_t column = 0; column < kFftColumns; column += 4) {
            const float* in = block + row * kFftColumns + column;
            const auto a = hn::LoadU(d, in);
            const auto b = hn::LoadU(d, in + kFftColumns);
            const auto c = hn::LoadU(d, in + 2 * kFftColumns);
            const auto e = hn::LoadU(d, in + 3 * kFftColumns);
            const auto ab_low = hn::BitCast(pairs, hn::InterleaveLower(d, a, b));
            const auto ab_high = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b));
            const auto ce_low = hn::BitCast(pairs, hn::InterleaveLower(d, c, e));
            const auto ce_high = hn::BitCast(pairs, hn::InterleaveUpper(d, c, e));
            float* out = to + column * pitch + row;
            hn::StoreU(hn::BitCast(d, hn::InterleaveLower(pairs, ab_low, ce_low)), d, out);
            hn::StoreU(hn::BitCast(d, hn::InterleaveUpper(pairs, ab_low, ce_low)), d, out + pitch);
            hn::StoreU(
                hn::BitCast(d, hn::InterleaveLower(pairs, ab_high, ce_high)), d, out + 2 * pitch);
            hn::StoreU(
                hn::BitCast(d, hn::InterleaveUpper(pairs, ab_high, ce_high)), d, out + 3 * pitch);
        }
    }
#endif
}

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(inverse_columns_vector);
HWY_EXPORT(transpose_columns_vector);

bool is_fft_size(std::size_t size) {
    return size >= 16 && size <= 4096 && (size & (size - 1)) == 0;
}

FftPlan make_fft_plan(std::size_t size) {
    LIMN_CHECK(is_fft_size(size));
    FftPlan plan{size, std::vector<float>(size), std::vector<float>(size)};
    for (std::size_t i = 0; i < size; ++i) {
        const double angle = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(size);
        plan.cosines[i] = static_cast<float>(std::cos(angle));
        plan.sines[i] = static_cast<float>(std::sin(angle));
    }
    return plan;
}

void inverse_fft_columns(
    const FftPlan& plan, const FftColumns& from, const FftColumns& to, std::span<float> scratch) {
    LIMN_CHECK(scratch.size() >= fft_scratch_size(plan.size));
    HWY_DYNAMIC_DISPATCH(inverse_columns_vector)(plan, from, to, scratch.data());
}

void inverse_fft_columns_scalar(
    const FftPlan& plan, const FftColumns& from, const FftColumns& to, std::span<float> scratch) {
    LIMN_CHECK(scratch.size() >= fft_scratch_size(plan.size));
    HWY_STATIC_DISPATCH(inverse_columns_one_lane)(plan, from, to, scratch.data());
}

void transpose_columns(const float* block, std::size_t rows, float* to, std::size_t pitch) {
    LIMN_CHECK(rows % 4 == 0);
    HWY_DYNAMIC_DISPATCH(transpose_columns_vector)(block, rows, to, pitch);
}

void inverse_fft_2d(
    const FftPlan& plan, std::span<const float> spectrum_re, std::span<const float> spectrum_im,
    std::span<float> field_re, std::span<float> field_im) {
    const std::size_t size = plan.size;
    LIMN_CHECK(spectrum_re.size() == size * size && spectrum_im.size() == size * size);
    LIMN_CHECK(field_re.size() == size * size && field_im.size() == size * size);
    const std::size_t blocks = size / kFftColumns;
    const std::size_t plane = size * kFftColumns;
    parallel_for(blocks, 1, [&](std::size_t begin, std::size_t) {
        thread_local std::vector<float> memory;
        memory.resize(2 * plane + fft_scratch_size(size));
        const std::size_t first = begin * kFftColumns;
        // The transform only reads its input.
        const FftColumns from = {
            const_cast<float*>(spectrum_re.data()) + first,
            const_cast<float*>(spectrum_im.data()) + first, size};
        const FftColumns block = {memory.data(), memory.data() + plane, kFftColumns};
        inverse_fft_columns(plan, from, block, std::span(memory).subspan(2 * plane));
        transpose_columns(block.re, size, field_re.data() + first * size, size);
        transpose_columns(block.im, size, field_im.data() + first * size, size);
    });
    parallel_for(blocks, 1, [&](std::size_t begin, std::size_t) {
        thread_local std::vector<float> memory;
        memory.resize(fft_scratch_size(size));
        const FftColumns columns = {
            field_re.data() + begin * kFftColumns, field_im.data() + begin * kFftColumns, size};
        inverse_fft_columns(plan, columns, columns, memory);
    });
}

}  // namespace limn
#endif  // HWY_ONCE
