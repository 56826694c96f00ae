#include "content/app/commands/exposure_samples.h"

#include <array>
#include <cstdint>

// Techniques: post.distributed-sampling

namespace limn {
namespace {

constexpr int kDimensions = 4;
constexpr int kBits = 32;
using Directions = std::array<std::uint32_t, kBits>;

/// Direction numbers of the primitive polynomial with `degree` and inner coefficients `a`; `m` are
/// the initial ones.
constexpr Directions
make_directions(std::size_t degree, std::uint32_t a, std::array<std::uint32_t, 3> m) {
    Directions v = {};
    for (std::size_t i = 0; i < kBits; ++i) {
        if (i < degree) {
            v[i] = m[i] << (31 - i);
            continue;
        }
        v[i] = v[i - degree] ^ (v[i - degree] >> degree);
        for (std::size_t k = 1; k < degree; ++k) {
            if (((a >> (degree - 1 - k)) & 1u) != 0) {
                v[i] ^= v[i - k];
            }
        }
    }
    return v;
}

constexpr Directions van_der_corput() {
    Directions v = {};
    for (std::size_t i = 0; i < kBits; ++i) {
        v[i] = 0x80000000u >> i;
    }
    return v;
}

/// S. Joe and F. Kuo, "Constructing Sobol sequences with better two-dimensional projections"
/// (2008).
constexpr std::array<Directions, kDimensions> kSobol = {
    van_der_corput(), make_directions(1, 0, {1, 0, 0}), make_directions(2, 1, {1, 3, 0}),
    make_directions(3, 1, {1, 3, 1})};

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
    std::uint32_t reversed = 0;
    for (int i = 0; i < kBits; ++i, x >>= 1) {
        reversed = (reversed << 1) | (x & 1u);
    }
    return reversed;
}

/// Randomly swaps halves, quarters and so on of 0 .. 1 (B. Burley, "Practical Hash-based Owen
/// Scrambling", 2020).
constexpr std::uint32_t scramble(std::uint32_t x, std::uint32_t seed) {
    x = reverse_bits(x) + seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return reverse_bits(x);
}

/// Coordinate `dimension` of point `index` of the sequence, 0 .. 1.
float coordinate(std::uint32_t index, std::size_t dimension) {
    constexpr std::array<std::uint32_t, kDimensions> kSeeds = {
        0x9e3779b9u, 0x7f4a7c15u, 0x94d049bbu, 0x2545f491u};
    std::uint32_t x = 0;
    for (std::size_t bit = 0; bit < kBits; ++bit) {
        x ^= ((index >> bit) & 1u) != 0 ? kSobol[dimension][bit] : 0u;
    }
    return static_cast<float>(scramble(x, kSeeds[dimension]) >> 8) * 0x1p-24f;
}

}  // namespace

ExposureSample exposure_sample(int index, int count) {
    if (count <= 1) {
        return {};
    }
    const auto i = static_cast<std::uint32_t>(index);
    return {
        (index + 0.5) / count - 0.5,
        Vec2(coordinate(i, 0), coordinate(i, 1)) - 0.5f,
        {coordinate(i, 2), coordinate(i, 3)}};
}

}  // namespace limn
