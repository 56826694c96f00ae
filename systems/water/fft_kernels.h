#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace limn {

// The inverse Fourier transform of complex fields on square grids, without a factor:
//
//     field(x, z) = sum over n, m of spectrum(n, m) e^(2 pi i (n x + m z) / size)
//
// Sixteen neighboring columns are transformed at once, a vector register holding the same row of
// several of them, so that no step has to shuffle. The order within a column is Stockham's
// ("High-speed convolution and correlation", 1966): no bit reversal, from one block to another
// and back; radix 4, and 2 at the end where the size is no power of four. Real and imaginary
// parts lie in planes of their own.
//
// 256 x 256 complex takes a fifth of KissFFT's time on one core (water_bench). Bits are the same
// for any width of the vectors, one lane (`_scalar`) among them: no fused multiply-add.

/// Sizes that can be transformed: powers of two, 16 .. 4096.
[[nodiscard]] bool is_fft_size(std::size_t size);

/// What depends on the size alone.
struct FftPlan {
    std::size_t size = 0;
    std::vector<float> cosines;  ///< of 2 pi i / size
    std::vector<float> sines;
};

[[nodiscard]] FftPlan make_fft_plan(std::size_t size);

/// Columns that are transformed together.
inline constexpr std::size_t kFftColumns = 16;

/// Rows of kFftColumns complex numbers, within something wider or by themselves.
struct FftColumns {
    float* re = nullptr;
    float* im = nullptr;
    std::size_t pitch = kFftColumns;  ///< from row to row [floats]
};

/// How much the transform of a block of columns needs for itself [floats].
[[nodiscard]] constexpr std::size_t fft_scratch_size(std::size_t size) {
    return 4 * kFftColumns * size;
}

/// Transforms each of kFftColumns columns of plan.size rows. `from` and `to` may be the same.
void inverse_fft_columns(
    const FftPlan& plan, const FftColumns& from, const FftColumns& to, std::span<float> scratch);
void inverse_fft_columns_scalar(
    const FftPlan& plan, const FftColumns& from, const FftColumns& to, std::span<float> scratch);

/// Column c of a block of `rows` rows becomes row c of what begins at `to`; `rows` is a multiple
/// of 4.
void transpose_columns(const float* block, std::size_t rows, float* to, std::size_t pitch);

/// Both directions, on all threads: spectrum(n, m) at n * size + m becomes field(x, z) at
/// z * size + x. No plane may be another.
void inverse_fft_2d(
    const FftPlan& plan, std::span<const float> spectrum_re, std::span<const float> spectrum_im,
    std::span<float> field_re, std::span<float> field_im);

}  // namespace limn
