#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace limn {

// Decodes textures in blocks of 4 x 4 texels in 16 bytes: BC5 (RGTC2, two channels) and BC7 (BPTC,
// four channels). Any 16 bytes are a valid block. After the Khronos Data Format Specification 1.3,
// chapters "RGTC Compressed Texture Image Formats" and "BPTC Compressed Texture Image Formats"; the
// tables of BC7 are for encoders, too.

inline constexpr int kBlockSide = 4;    ///< [texels]
inline constexpr int kBlockBytes = 16;  ///< of BC5 and BC7

using BlockBytes = std::array<std::uint8_t, kBlockBytes>;
/// RGBA; the texel (x, y) is at y * 4 + x, rows from the top.
using BlockTexels = std::array<std::array<std::uint8_t, 4>, kBlockSide * kBlockSide>;

/// Red and green, each rounded to 8 bits: hardware may be more precise. Blue is 0, alpha 255.
[[nodiscard]] BlockTexels decode_bc5(std::span<const std::uint8_t, kBlockBytes> block);

/// Exact: all hardware has the same bits. The reserved mode is transparent black.
[[nodiscard]] BlockTexels decode_bc7(std::span<const std::uint8_t, kBlockBytes> block);

/// The fields of a block of BC7, in their order: as many zeros as the mode and a one, partition,
/// rotation, index selection, red of all endpoints, green, blue, alpha, p-bits, indices.
struct Bc7Mode {
    int subsets;
    int partition_bits;
    int rotation_bits;
    int selection_bits;
    int color_bits;
    int alpha_bits;      ///< 0: opaque
    int endpoint_pbits;  ///< 1: a lowest bit of all channels of each endpoint
    int subset_pbits;    ///< 1: of both endpoints of a subset
    int index_bits;
    int second_index_bits;  ///< of alpha; of color if selected. 0: there is one index
};
inline constexpr std::array<Bc7Mode, 8> kBc7Modes = {{
    {3, 4, 0, 0, 4, 0, 1, 0, 3, 0},
    {2, 6, 0, 0, 6, 0, 0, 1, 3, 0},
    {3, 6, 0, 0, 5, 0, 0, 0, 2, 0},
    {2, 6, 0, 0, 7, 0, 1, 0, 2, 0},
    {1, 0, 2, 1, 5, 6, 0, 0, 2, 3},
    {1, 0, 2, 0, 7, 8, 0, 0, 2, 2},
    {1, 0, 0, 0, 7, 7, 1, 0, 4, 0},
    {2, 6, 0, 0, 5, 5, 1, 0, 2, 0},
}};

/// Subset of a texel, 0 .. subsets - 1.
[[nodiscard]] int bc7_subset(int subsets, int partition, int texel);
/// The texel of a subset whose index is stored without its highest bit, which is 0.
[[nodiscard]] int bc7_anchor(int subsets, int partition, int subset);
/// Weights of the second endpoint, in 64ths, by index of 2, 3 or 4 bits.
[[nodiscard]] std::span<const std::uint8_t> bc7_weights(int index_bits);
/// The 8 bits of an endpoint's channel that is stored in `bits`, 4 .. 8.
[[nodiscard]] constexpr int bc7_expanded(int code, int bits) {
    const int high = code << (8 - bits);
    return high | (high >> bits);
}

}  // namespace limn
