#include "ecs/base/block_texture.h"

#include <utility>

namespace limn {
namespace {

/// One bit a texel, the first lowest.
constexpr std::array<std::uint16_t, 64> kTwoSubsets = {
    0xcccc, 0x8888, 0xeeee, 0xecc8, 0xc880, 0xfeec, 0xfec8, 0xec80, 0xc800, 0xffec, 0xfe80,
    0xe800, 0xffe8, 0xff00, 0xfff0, 0xf000, 0xf710, 0x008e, 0x7100, 0x08ce, 0x008c, 0x7310,
    0x3100, 0x8cce, 0x088c, 0x3110, 0x6666, 0x366c, 0x17e8, 0x0ff0, 0x718e, 0x399c, 0xaaaa,
    0xf0f0, 0x5a5a, 0x33cc, 0x3c3c, 0x55aa, 0x9696, 0xa55a, 0x73ce, 0x13c8, 0x324c, 0x3bdc,
    0x6996, 0xc33c, 0x9966, 0x0660, 0x0272, 0x04e4, 0x4e40, 0x2720, 0xc936, 0x936c, 0x39c6,
    0x639c, 0x9336, 0x9cc6, 0x817e, 0xe718, 0xccf0, 0x0fcc, 0x7744, 0xee22};

/// Two bits a texel.
constexpr std::array<std::uint32_t, 64> kThreeSubsets = {
    0xaa685050, 0x6a5a5040, 0x5a5a4200, 0x5450a0a8, 0xa5a50000, 0xa0a05050, 0x5555a0a0, 0x5a5a5050,
    0xaa550000, 0xaa555500, 0xaaaa5500, 0x90909090, 0x94949494, 0xa4a4a4a4, 0xa9a59450, 0x2a0a4250,
    0xa5945040, 0x0a425054, 0xa5a5a500, 0x55a0a0a0, 0xa8a85454, 0x6a6a4040, 0xa4a45000, 0x1a1a0500,
    0x0050a4a4, 0xaaa59090, 0x14696914, 0x69691400, 0xa08585a0, 0xaa821414, 0x50a4a450, 0x6a5a0200,
    0xa9a58000, 0x5090a0a8, 0xa8a09050, 0x24242424, 0x00aa5500, 0x24924924, 0x24499224, 0x50a50a50,
    0x500aa550, 0xaaaa4444, 0x66660000, 0xa5a0a5a0, 0x50a050a0, 0x69286928, 0x44aaaa44, 0x66666600,
    0xaa444444, 0x54a854a8, 0x95809580, 0x96969600, 0xa85454a8, 0x80959580, 0xaa141414, 0x96960000,
    0xaaaa1414, 0xa05050a0, 0xa0a5a5a0, 0x96000000, 0x40804080, 0xa9a8a9a8, 0xaaaaaa44, 0x2a4a5254};

constexpr std::array<std::uint8_t, 64> kSecondOfTwo = {
    15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 2,  8, 2, 2, 8,
    8,  15, 2,  8,  2,  2,  8,  8,  2,  2,  15, 15, 6,  8,  2,  8,  15, 15, 2, 8, 2, 2,
    2,  15, 15, 6,  6,  2,  6,  8,  15, 15, 2,  2,  15, 15, 15, 15, 15, 2,  2, 15};
constexpr std::array<std::uint8_t, 64> kSecondOfThree = {
    3,  3,  15, 15, 8, 3,  15, 15, 8,  8,  6, 6,  6, 5,  3, 3,  3,  3,  8,  15, 3,  3,
    6,  10, 5,  8,  8, 6,  8,  5,  15, 15, 8, 15, 3, 5,  6, 10, 8,  15, 15, 3,  15, 5,
    15, 15, 15, 15, 3, 15, 5,  5,  5,  8,  5, 10, 5, 10, 8, 13, 15, 12, 3,  3};
constexpr std::array<std::uint8_t, 64> kThirdOfThree = {
    15, 8, 8, 3,  15, 15, 3,  8,  15, 15, 15, 15, 15, 15, 15, 8,  15, 8,  15, 3,  15, 8,
    15, 8, 3, 15, 6,  10, 15, 15, 10, 8,  15, 3,  15, 10, 10, 8,  9,  10, 6,  15, 8,  15,
    3,  6, 6, 8,  15, 3,  15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 3,  15, 15, 8};

constexpr std::array<std::uint8_t, 4> kWeights2 = {0, 21, 43, 64};
constexpr std::array<std::uint8_t, 8> kWeights3 = {0, 9, 18, 27, 37, 46, 55, 64};
constexpr std::array<std::uint8_t, 16> kWeights4 = {0,  4,  9,  13, 17, 21, 26, 30,
                                                    34, 38, 43, 47, 51, 55, 60, 64};

/// Bits of a block, from the lowest of the first byte on.
class BlockBits {
  public:
    explicit BlockBits(std::span<const std::uint8_t, kBlockBytes> block) : block_(block) {}
    [[nodiscard]] int take(int count) {
        int value = 0;
        for (int i = 0; i < count; ++i, ++at_) {
            value |= ((block_[static_cast<std::size_t>(at_ / 8)] >> (at_ % 8)) & 1) << i;
        }
        return value;
    }

  private:
    std::span<const std::uint8_t, kBlockBytes> block_;
    int at_ = 0;
};

/// Endpoints with all bits: those of subset s are 2 s and 2 s + 1.
using Bc7Endpoints = std::array<std::array<int, 4>, 6>;

Bc7Endpoints read_endpoints(BlockBits& bits, const Bc7Mode& mode) {
    Bc7Endpoints ends = {};
    const auto count = static_cast<std::size_t>(2 * mode.subsets);
    for (std::size_t c = 0; c < 4; ++c) {
        for (std::size_t e = 0; e < count; ++e) {
            ends[e][c] = bits.take(c < 3 ? mode.color_bits : mode.alpha_bits);
        }
    }
    std::array<int, 6> low = {};
    for (std::size_t e = 0; e < count; ++e) {
        if (mode.endpoint_pbits != 0 || (mode.subset_pbits != 0 && e % 2 == 0)) {
            low[e] = bits.take(1);
        } else if (mode.subset_pbits != 0) {
            low[e] = low[e - 1];
        }
    }
    const int extra = mode.endpoint_pbits + mode.subset_pbits;
    for (std::size_t e = 0; e < count; ++e) {
        for (std::size_t c = 0; c < 4; ++c) {
            const int stored = c < 3 ? mode.color_bits : mode.alpha_bits;
            ends[e][c] =
                stored == 0
                    ? 255
                    : bc7_expanded((ends[e][c] << extra) | (extra * low[e]), stored + extra);
        }
    }
    return ends;
}

bool is_anchor(int subsets, int partition, int texel) {
    for (int s = 0; s < subsets; ++s) {
        if (bc7_anchor(subsets, partition, s) == texel) {
            return true;
        }
    }
    return false;
}

std::uint8_t mixed(int a, int b, int weight) {
    return static_cast<std::uint8_t>(((64 - weight) * a + weight * b + 32) >> 6);
}

/// One channel of BC5, which is a block of BC4.
std::array<std::uint8_t, 16> decode_bc4(const std::uint8_t* half) {
    const int a = half[0];
    const int b = half[1];
    std::array<int, 8> palette = {a, b, 0, 0, 0, 0, 0, 255};
    const int steps = a > b ? 7 : 5;  // the smaller one first: black and white are colors, too
    for (int i = 1; i < steps; ++i) {
        palette[static_cast<std::size_t>(i + 1)] = ((steps - i) * a + i * b + steps / 2) / steps;
    }
    std::uint64_t indices = 0;
    for (int i = 0; i < 6; ++i) {
        indices |= std::uint64_t{half[2 + i]} << (8 * i);
    }
    std::array<std::uint8_t, 16> values;
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = static_cast<std::uint8_t>(palette[(indices >> (3 * i)) & 7]);
    }
    return values;
}

}  // namespace

int bc7_subset(int subsets, int partition, int texel) {
    const auto p = static_cast<std::size_t>(partition);
    return subsets == 2   ? (kTwoSubsets[p] >> texel) & 1
           : subsets == 3 ? static_cast<int>((kThreeSubsets[p] >> (2 * texel)) & 3)
                          : 0;
}

int bc7_anchor(int subsets, int partition, int subset) {
    const auto p = static_cast<std::size_t>(partition);
    return subset == 0    ? 0
           : subsets == 2 ? kSecondOfTwo[p]
           : subset == 1  ? kSecondOfThree[p]
                          : kThirdOfThree[p];
}

std::span<const std::uint8_t> bc7_weights(int index_bits) {
    return index_bits == 2   ? std::span<const std::uint8_t>(kWeights2)
           : index_bits == 3 ? std::span<const std::uint8_t>(kWeights3)
                             : std::span<const std::uint8_t>(kWeights4);
}

BlockTexels decode_bc5(std::span<const std::uint8_t, kBlockBytes> block) {
    const auto red = decode_bc4(block.data());
    const auto green = decode_bc4(block.data() + 8);
    BlockTexels texels;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        texels[i] = {red[i], green[i], 0, 255};
    }
    return texels;
}

BlockTexels decode_bc7(std::span<const std::uint8_t, kBlockBytes> block) {
    BlockTexels texels = {};
    BlockBits bits(block);
    std::size_t number = 0;
    while (number < kBc7Modes.size() && bits.take(1) == 0) {
        ++number;
    }
    if (number == kBc7Modes.size()) {
        return texels;
    }
    const Bc7Mode& mode = kBc7Modes[number];
    const int partition = bits.take(mode.partition_bits);
    const int rotation = bits.take(mode.rotation_bits);
    const bool selected = bits.take(mode.selection_bits) != 0;
    const Bc7Endpoints ends = read_endpoints(bits, mode);

    std::array<int, 16> first = {};
    std::array<int, 16> second = {};
    for (int i = 0; i < 16; ++i) {
        const int less = is_anchor(mode.subsets, partition, i) ? 1 : 0;
        first[static_cast<std::size_t>(i)] = bits.take(mode.index_bits - less);
    }
    for (int i = 0; i < 16 && mode.second_index_bits > 0; ++i) {
        second[static_cast<std::size_t>(i)] = bits.take(mode.second_index_bits - (i == 0 ? 1 : 0));
    }
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const int own = bc7_weights(mode.index_bits)[static_cast<std::size_t>(first[i])];
        const int other =
            mode.second_index_bits > 0
                ? bc7_weights(mode.second_index_bits)[static_cast<std::size_t>(second[i])]
                : own;
        const auto s =
            static_cast<std::size_t>(2 * bc7_subset(mode.subsets, partition, static_cast<int>(i)));
        for (std::size_t c = 0; c < 4; ++c) {
            texels[i][c] = mixed(ends[s][c], ends[s + 1][c], (c < 3) == selected ? other : own);
        }
        if (rotation > 0) {
            std::swap(texels[i][3], texels[i][static_cast<std::size_t>(rotation - 1)]);
        }
    }
    return texels;
}

}  // namespace limn
