#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace limn {

// Inverse Fourier transform of complex fields on square grids, unnormalized:
//
//     field(x, z) = sum over n, m of spectrum(n, m) e^(2 pi i (n x + m z) / size)
//
// Sixteen neighboring columns are transformed at once; a vector register holds the same row of
// several of them, so that no step needs shuffles. Stockham's algorithm ("High-speed convolution
// and correlation", 1966) alternates between two buffers and needs no bit reversal; radix 4, with a
// final radix-2 step if the size is not a power of four. Real and imaginary parts are in separate
// planes.
//
// 256 x 256 complex takes a fifth of KissFFT's time on one core (water_bench). Results are
// bit-identical for any vector width, including one lane (`_scalar`): no fused multiply-add.

/// Supported sizes: powers of two, 16 .. 4096.
[[nodiscard]] bool is_fft_size(std::size_t size);

/// Precomputed data for one size.
struct FftPlan {
    std::size_t size = 0;
    std::vector<float> cosines;  ///< of 2 pi i / size
    std::vector<float> sines;
};

[[nodiscard]] FftPlan make_fft_plan(std::size_t size);

/// Columns transformed together.
inline constexpr std::size_t kFftColumns = 16;

/// Rows of kFftColumns complex numbers, possibly part of a wider array.
struct FftColumns {
    float* re = nullptr;
    float* im = nullptr;
    std::size_t pitch = kFftColumns;  ///< row stride [floats]
};

/// Scratch memory for the transform of a block of columns [floats].
[[nodiscard]] constexpr std::size_t fft_scratch_size(std::size_t size) {
    return 4 * kFftColumns * size;
}

/// Transforms each of kFftColumns columns of plan.size rows. `from` and `to` may be the same.
void inverse_fft_columns(
    const FftPlan& plan, const FftColumns& from, const FftColumns& to, std::span<float> scratch);
void inverse_fft_columns_scalar(
    const FftPlan& plan, const FftColumns& from, const FftColumns& to, std::span<float> scratch);

/// Transposes a block of `rows` rows: column c becomes row c at `to`. `rows` is a multiple of 4.
void transpose_columns(const float* block, std::size_t rows, float* to, std::size_t pitch);

/// 2D transform on all threads: from spectrum(n, m) at n * size + m to field(x, z) at z * size + x.
/// The four planes must not overlap.
void inverse_fft_2d(
    const FftPlan& plan, std::span<const float> spectrum_re, std::span<const float> spectrum_im,
    std::span<float> field_re, std::span<float> field_im);

}  // namespace limn
