#include "bench/oracles/water_oracle.h"
#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "systems/water/fft_kernels.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <kissfft/kiss_fftnd.h>

#include <algorithm>
#include <complex>
#include <cstring>
#include <vector>

namespace limn::fft_kernels_test {
namespace {

using oracle::Complex;

struct Planes {
    std::vector<float> re;
    std::vector<float> im;

    explicit Planes(std::size_t count) : re(count), im(count) {}
    [[nodiscard]] Complex at(std::size_t i) const { return {re[i], im[i]}; }
    [[nodiscard]] std::vector<Complex> numbers() const {
        std::vector<Complex> z;
        for (std::size_t i = 0; i < re.size(); ++i) {
            z.push_back(at(i));
        }
        return z;
    }
    bool operator==(const Planes&) const = default;
};

Planes noise(std::size_t count) {
    Planes planes(count);
    Random random(1, count, name_hash("fft_test"), 0);
    for (std::size_t i = 0; i < count; ++i) {
        planes.re[i] = random.normal();
        planes.im[i] = random.normal();
    }
    return planes;
}

Planes inverse_2d(const Planes& spectrum, std::size_t size) {
    Planes field(size * size);
    inverse_fft_2d(make_fft_plan(size), spectrum.re, spectrum.im, field.re, field.im);
    return field;
}

template <auto kernel = inverse_fft_columns>
Planes inverse_columns(const Planes& from, std::size_t size) {
    Planes in = from;
    Planes out(from.re.size());
    std::vector<float> scratch(fft_scratch_size(size));
    kernel(
        make_fft_plan(size), {in.re.data(), in.im.data()}, {out.re.data(), out.im.data()}, scratch);
    return out;
}

/// The transform in the other direction: conjugated before and after.
Planes forward_columns(Planes from, std::size_t size) {
    for (float& im : from.im) {
        im = -im;
    }
    Planes to = inverse_columns(from, size);
    for (float& im : to.im) {
        im = -im;
    }
    return to;
}

/// Largest difference over the largest number.
template <typename Expected>
double relative_error(const Planes& found, const Expected& expected) {
    double error = 0;
    double largest = 0;
    for (std::size_t i = 0; i < found.re.size(); ++i) {
        error = std::max(error, std::abs(found.at(i) - expected(i)));
        largest = std::max(largest, std::abs(expected(i)));
    }
    return error / largest;
}

constexpr std::size_t kSizes[] = {16, 32, 64, 128, 256, 512, 1024, 2048, 4096};

}  // namespace

TEST_CASE(
    "fft: it is the sum of all waves, to 1e-6 of the largest" * technique("water.fft-synthesis")) {
    for (const std::size_t size : {16, 32, 64, 128}) {
        CAPTURE(size);
        const Planes spectrum = noise(size * size);
        const std::vector<Complex> sum = oracle::inverse_dft_2d(spectrum.numbers(), size);
        const Planes field = inverse_2d(spectrum, size);
        CHECK(relative_error(field, [&](std::size_t i) { return sum[i]; }) < 1e-6);
    }
}

TEST_CASE(
    "fft: KissFFT finds the same, to 1e-6 of the largest" * technique("water.fft-synthesis")) {
    for (const std::size_t size : {256, 512, 1024}) {
        CAPTURE(size);
        const Planes spectrum = noise(size * size);
        std::vector<kiss_fft_cpx> in;
        for (std::size_t i = 0; i < size * size; ++i) {
            in.push_back({spectrum.re[i], spectrum.im[i]});
        }
        std::vector<kiss_fft_cpx> out(size * size);
        const int sizes[] = {static_cast<int>(size), static_cast<int>(size)};
        kiss_fftnd_cfg plan = kiss_fftnd_alloc(sizes, 2, 1, nullptr, nullptr);
        kiss_fftnd(plan, in.data(), out.data());
        kiss_fft_free(plan);
        const auto expected = [&](std::size_t i) {  // theirs is not transposed
            const kiss_fft_cpx& z = out[i % size * size + i / size];
            return Complex(z.r, z.i);
        };
        CHECK(relative_error(inverse_2d(spectrum, size), expected) < 1e-6);
    }
}

TEST_CASE("fft: columns of every size are transformed independently") {
    for (const std::size_t size : kSizes) {
        CAPTURE(size);
        const Planes from = noise(kFftColumns * size);
        const Planes to = inverse_columns(from, size);
        for (const std::size_t column : {std::size_t{0}, std::size_t{7}, kFftColumns - 1}) {
            std::vector<Complex> line;
            for (std::size_t row = 0; row < size; ++row) {
                line.push_back(from.at(row * kFftColumns + column));
            }
            const std::vector<Complex> sum = oracle::inverse_dft(line);
            double error = 0;
            for (std::size_t row = 0; row < size; ++row) {
                error = std::max(error, std::abs(to.at(row * kFftColumns + column) - sum[row]));
            }
            CHECK(error < 1e-6 * 4.0 * std::sqrt(2.0 * static_cast<double>(size)));
        }
    }
}

TEST_CASE("fft: forward and inverse give size times the input" * technique("water.fft-synthesis")) {
    for (const std::size_t size : kSizes) {
        CAPTURE(size);
        const Planes from = noise(kFftColumns * size);
        const Planes back = inverse_columns(forward_columns(from, size), size);
        const double count = static_cast<double>(size);
        CHECK(relative_error(back, [&](std::size_t i) { return count * from.at(i); }) < 1e-6);
    }
}

TEST_CASE(
    "fft: a column has the energy of its waves times size (Parseval)"
    * technique("water.fft-synthesis")) {
    for (const std::size_t size : kSizes) {
        CAPTURE(size);
        const Planes from = noise(kFftColumns * size);
        const Planes to = forward_columns(from, size);
        double before = 0;
        double after = 0;
        for (std::size_t i = 0; i < from.re.size(); ++i) {
            before += std::norm(from.at(i));
            after += std::norm(to.at(i));
        }
        CHECK(after / static_cast<double>(size) == test::near(before).epsilon(1e-6));
    }
}

TEST_CASE(
    "fft: a single wave with number 0 is constant, to the bit" * technique("water.fft-synthesis")) {
    for (const std::size_t size : {16, 32, 64}) {
        Planes spectrum(size * size);
        spectrum.re[0] = 1.7f;
        const Planes field = inverse_2d(spectrum, size);
        for (std::size_t i = 0; i < size * size; ++i) {
            CHECK(field.at(i) == spectrum.at(0));
        }
    }
}

TEST_CASE(
    "fft: a wave and its mirror image are a cosine of twice the height"
    * technique("water.fft-synthesis")) {
    constexpr std::size_t kSize = 32;
    constexpr std::size_t kN = 3;
    constexpr std::size_t kM = 5;
    const Complex h = std::polar(0.25, 0.7);
    Planes spectrum(kSize * kSize);
    for (const bool mirrored : {false, true}) {
        const std::size_t n = mirrored ? kSize - kN : kN;
        const std::size_t m = mirrored ? kSize - kM : kM;
        spectrum.re[n * kSize + m] = static_cast<float>(h.real());
        spectrum.im[n * kSize + m] = static_cast<float>(mirrored ? -h.imag() : h.imag());
    }
    const Planes field = inverse_2d(spectrum, kSize);
    for (std::size_t z = 0; z < kSize; ++z) {
        for (std::size_t x = 0; x < kSize; ++x) {
            const double turns = static_cast<double>(kN * x + kM * z) / kSize;
            const double wave = 0.5 * std::cos(oracle::kFullTurn * turns + 0.7);
            CHECK(std::abs(field.at(z * kSize + x) - wave) < 5e-7);
        }
    }
}

TEST_CASE("fft: SIMD of any width gives the bits of one lane") {
    for (const std::size_t size : kSizes) {
        CAPTURE(size);
        const Planes from = noise(kFftColumns * size);
        const Planes wide = inverse_columns<inverse_fft_columns>(from, size);
        const Planes narrow = inverse_columns<inverse_fft_columns_scalar>(from, size);
        CHECK(wide == narrow);
    }
}

TEST_CASE("fft: columns can be transformed in place, within a wider array") {
    constexpr std::size_t kSize = 64;
    constexpr std::size_t kPitch = 50;
    const Planes from = noise(kFftColumns * kSize);
    Planes wider(kPitch * kSize);
    for (std::size_t i = 0; i < from.re.size(); ++i) {
        const std::size_t at = i / kFftColumns * kPitch + 20 + i % kFftColumns;
        wider.re[at] = from.re[i];
        wider.im[at] = from.im[i];
    }
    const FftColumns columns = {wider.re.data() + 20, wider.im.data() + 20, kPitch};
    std::vector<float> scratch(fft_scratch_size(kSize));
    inverse_fft_columns(make_fft_plan(kSize), columns, columns, scratch);
    const Planes expected = inverse_columns(from, kSize);
    for (std::size_t row = 0; row < kSize; ++row) {
        for (std::size_t column = 0; column < kPitch; ++column) {
            const bool inside = column >= 20 && column < 20 + kFftColumns;
            const Complex z =
                inside ? expected.at(row * kFftColumns + column - 20) : Complex(0.0, 0.0);
            CHECK(wider.at(row * kPitch + column) == z);
        }
    }
}

TEST_CASE("fft: a transposed block has columns for rows") {
    constexpr std::size_t kRows = 12;
    const Planes from = noise(kFftColumns * kRows);
    std::vector<float> to(kFftColumns * 20);
    transpose_columns(from.re.data(), kRows, to.data(), 20);
    for (std::size_t i = 0; i < to.size(); ++i) {
        const std::size_t row = i % 20;
        CHECK(to[i] == (row < kRows ? from.re[row * kFftColumns + i / 20] : 0.0f));
    }
}

TEST_CASE("fft: any number of threads gives the same bits") {
    constexpr std::size_t kSize = 128;
    const Planes spectrum = noise(kSize * kSize);
    const int before = thread_count();
    set_thread_count(1);
    const Planes alone = inverse_2d(spectrum, kSize);
    for (const int threads : {2, 5}) {
        set_thread_count(threads);
        set_task_shuffle(static_cast<std::uint64_t>(threads));
        CHECK(inverse_2d(spectrum, kSize) == alone);
    }
    set_task_shuffle(0);
    set_thread_count(before);
}

TEST_CASE("fft: sizes are the powers of two from 16 to 4096") {
    std::size_t count = 0;
    for (std::size_t size = 0; size < 10000; ++size) {
        count += is_fft_size(size) ? 1 : 0;
    }
    CHECK(count == std::size(kSizes));
    for (const std::size_t size : kSizes) {
        CHECK(is_fft_size(size));
    }
}

}  // namespace limn::fft_kernels_test
