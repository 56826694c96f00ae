#include "content/bake/block_encode.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

// Techniques: engine.opt-texture

namespace limn {
namespace {

constexpr std::uint32_t kAllTexels = 0xffff;
constexpr int kFits = 3;             // of endpoints to indices, the first to the principal axis
constexpr float kHope = 1.7f;        // factor by which more fits may reduce the error of the first
constexpr int kTriedPartitions = 2;  // of mode 1
constexpr float kGoodBlock = 8;      // squared error of a block that no other mode is tried for

/// What a mode stores of the endpoints of the channels first .. first + count - 1.
struct LineFormat {
    std::size_t first = 0;
    std::size_t count = 4;
    int bits = 8;  ///< of a channel, with the p-bit
    int index_bits = 4;
    bool pbits = false;       ///< the lowest bit is common to the channels of an endpoint
    bool one_pbit = false;    ///< and of both endpoints
    bool high_pbits = false;  ///< p-bits are 1
};

/// Endpoints and indices of a subset.
struct LineFit {
    std::array<std::array<int, 4>, 2> codes = {};  ///< with p-bit
    std::array<int, 16> indices = {};
    float error = std::numeric_limits<float>::max();  ///< sum of squares
};

using ColorLine = std::array<Vec4, 2>;

template <typename Visit>
void each_texel(std::uint32_t subset, Visit&& visit) {
    for (std::size_t i = 0; i < 16; ++i) {
        if ((subset >> i & 1) != 0) {
            visit(i);
        }
    }
}

/// The direction in which the texels differ most, by power iteration; not normalized.
Vec4 principal_axis(const BlockColors& texels, std::uint32_t subset, const Vec4& mean) {
    std::array<Vec4, 4> covariance = {};
    each_texel(subset, [&](std::size_t i) {
        const Vec4 d = texels[i] - mean;
        for (int c = 0; c < 4; ++c) {
            covariance[static_cast<std::size_t>(c)] += d[c] * d;
        }
    });
    int widest = 0;
    for (int c = 1; c < 4; ++c) {
        if (covariance[static_cast<std::size_t>(c)][c]
            > covariance[static_cast<std::size_t>(widest)][widest]) {
            widest = c;
        }
    }
    Vec4 axis = covariance[static_cast<std::size_t>(widest)];
    for (int step = 0; step < 6; ++step) {
        const float scale = std::max(
            std::max(std::abs(axis.x), std::abs(axis.y)),
            std::max(std::abs(axis.z), std::abs(axis.w)));
        if (scale < 1e-6f) {
            return Vec4(0);
        }
        axis *= 1.0f / scale;
        axis = axis.x * covariance[0] + axis.y * covariance[1] + axis.z * covariance[2]
               + axis.w * covariance[3];
    }
    return axis;
}

/// The ends of the texels along their principal axis.
ColorLine principal_line(const BlockColors& texels, std::uint32_t subset) {
    Vec4 mean(0);
    float count = 0;
    each_texel(subset, [&](std::size_t i) {
        mean += texels[i];
        count += 1;
    });
    mean *= 1.0f / count;
    const Vec4 axis = principal_axis(texels, subset, mean);
    const float square = glm::dot(axis, axis);
    if (!(square > 0)) {
        return {mean, mean};
    }
    float low = 0;
    float high = 0;
    each_texel(subset, [&](std::size_t i) {
        const float at = glm::dot(texels[i] - mean, axis) / square;
        low = std::min(low, at);
        high = std::max(high, at);
    });
    return {mean + low * axis, mean + high * axis};
}

/// The line whose points at the weights of the indices are nearest to the texels.
ColorLine fitted_line(
    const BlockColors& texels, std::uint32_t subset, const LineFit& fit, int index_bits,
    const ColorLine& otherwise) {
    const std::span<const std::uint8_t> weights = bc7_weights(index_bits);
    float aa = 0;
    float ab = 0;
    float bb = 0;
    Vec4 a(0);
    Vec4 b(0);
    each_texel(subset, [&](std::size_t i) {
        const float w =
            static_cast<float>(weights[static_cast<std::size_t>(fit.indices[i])]) / 64.0f;
        aa += (1 - w) * (1 - w);
        ab += (1 - w) * w;
        bb += w * w;
        a += (1 - w) * texels[i];
        b += w * texels[i];
    });
    const float determinant = aa * bb - ab * ab;
    if (determinant < 1e-4f) {
        return otherwise;
    }
    return {(bb * a - ab * b) / determinant, (aa * b - ab * a) / determinant};
}

int nearest_code(float value, int bits, bool has_pbit, int pbit) {
    const float scaled = value * static_cast<float>((1 << bits) - 1) / 255.0f;
    const float limited = std::clamp(scaled, 0.0f, static_cast<float>((1 << bits) - 1));
    if (!has_pbit) {
        return static_cast<int>(limited + 0.5f);
    }
    const int high = (1 << (bits - 1)) - 1;
    const float half = 0.5f * (limited - static_cast<float>(pbit));
    return 2 * std::clamp(static_cast<int>(std::max(half, 0.0f) + 0.5f), 0, high) + pbit;
}

/// Takes the nearest indices; keeps the result in `best` if it is better.
void try_line(
    const BlockColors& texels, std::uint32_t subset, const LineFormat& format,
    const ColorLine& line, std::array<int, 2> pbits, LineFit& best) {
    LineFit fit;
    fit.error = 0;
    ColorLine ends = {Vec4(0), Vec4(0)};
    for (std::size_t e = 0; e < 2; ++e) {
        for (std::size_t c = format.first; c < format.first + format.count; ++c) {
            const auto channel = static_cast<int>(c);
            fit.codes[e][c] = nearest_code(line[e][channel], format.bits, format.pbits, pbits[e]);
            ends[e][channel] = static_cast<float>(bc7_expanded(fit.codes[e][c], format.bits));
        }
    }
    const std::span<const std::uint8_t> weights = bc7_weights(format.index_bits);
    const int last = static_cast<int>(weights.size()) - 1;
    const Vec4 along = ends[1] - ends[0];
    const float square = glm::dot(along, along);
    const Vec4 used = {
        format.first == 0 ? 1 : 0, format.first == 0 ? 1 : 0, format.first == 0 ? 1 : 0,
        format.first + format.count == 4 ? 1 : 0};
    each_texel(subset, [&](std::size_t i) {
        const Vec4 offset = used * (texels[i] - ends[0]);
        const float at = square > 0 ? glm::dot(offset, along) / square : 0.0f;
        const int index = std::clamp(
            static_cast<int>(std::max(at, 0.0f) * static_cast<float>(last) + 0.5f), 0, last);
        const float w = static_cast<float>(weights[static_cast<std::size_t>(index)]) / 64.0f;
        const Vec4 d = offset - w * along;
        fit.indices[i] = index;
        fit.error += glm::dot(d, d);
    });
    if (fit.error < best.error) {
        best = fit;
    }
}

void try_pbits(
    const BlockColors& texels, std::uint32_t subset, const LineFormat& format,
    const ColorLine& line, LineFit& best) {
    if (!format.pbits || format.high_pbits) {
        try_line(texels, subset, format, line, {1, 1}, best);
        return;
    }
    for (int p = 0; p < 4; ++p) {
        const std::array<int, 2> pbits = {p & 1, p >> 1};
        if (!format.one_pbit || pbits[0] == pbits[1]) {
            try_line(texels, subset, format, line, pbits, best);
        }
    }
}

/// Gives up, with some result, where the error is not going to be below `limit`.
LineFit
fit_line(const BlockColors& texels, std::uint32_t subset, const LineFormat& format, float limit) {
    LineFit best;
    BlockColors used = texels;
    for (Vec4& texel : used) {
        for (int c = 0; c < 4; ++c) {
            const auto at = static_cast<std::size_t>(c);
            texel[c] = at < format.first || at >= format.first + format.count ? 0 : texel[c];
        }
    }
    ColorLine line = principal_line(used, subset);
    for (int i = 0; i < kFits && (i == 0 || best.error < kHope * limit); ++i) {
        try_pbits(used, subset, format, line, best);
        line = fitted_line(used, subset, best, format.index_bits, line);
    }
    return best;
}

/// A block of any mode.
struct Bc7Block {
    std::size_t mode = 6;
    int partition = 0;
    int rotation = 0;
    std::array<LineFit, 2> lines;  ///< of the subsets
    LineFit alpha;                 ///< of mode 5
    float error = std::numeric_limits<float>::max();
};

void keep_better(Bc7Block& best, const Bc7Block& block) {
    if (block.error < best.error) {
        best = block;
    }
}

class BlockWriter {
  public:
    void put(int value, int count) {
        for (int i = 0; i < count; ++i, ++at_) {
            block_[static_cast<std::size_t>(at_ / 8)] |=
                static_cast<std::uint8_t>((value >> i & 1) << (at_ % 8));
        }
    }
    [[nodiscard]] const BlockBytes& block() const { return block_; }

  private:
    BlockBytes block_ = {};
    int at_ = 0;
};

/// Swaps the endpoints where the anchor's index has its highest bit set.
void clear_anchor(LineFit& fit, int anchor, int index_bits) {
    const int last = (1 << index_bits) - 1;
    if (fit.indices[static_cast<std::size_t>(anchor)] > last / 2) {
        std::swap(fit.codes[0], fit.codes[1]);
        for (int& index : fit.indices) {
            index = last - index;
        }
    }
}

void put_endpoints(BlockWriter& bits, const Bc7Block& block, const Bc7Mode& mode) {
    const int pbit = mode.endpoint_pbits + mode.subset_pbits;
    for (std::size_t c = 0; c < 4; ++c) {
        const bool is_alpha = c == 3;
        for (std::size_t s = 0; s < static_cast<std::size_t>(mode.subsets); ++s) {
            const LineFit& line =
                is_alpha && mode.second_index_bits > 0 ? block.alpha : block.lines[s];
            for (const std::array<int, 4>& codes : line.codes) {
                bits.put(codes[c] >> pbit, is_alpha ? mode.alpha_bits : mode.color_bits);
            }
        }
    }
    for (std::size_t s = 0; s < static_cast<std::size_t>(mode.subsets); ++s) {
        const LineFit& line = block.lines[s];
        bits.put(line.codes[0][0] & 1, pbit);
        bits.put(line.codes[1][0] & 1, mode.endpoint_pbits);
    }
}

BlockBytes write_block(Bc7Block block) {
    const Bc7Mode& mode = kBc7Modes[block.mode];
    BlockWriter bits;
    bits.put(1 << block.mode, static_cast<int>(block.mode) + 1);
    bits.put(block.partition, mode.partition_bits);
    bits.put(block.rotation, mode.rotation_bits);
    std::array<int, 2> anchors = {};
    for (int s = 0; s < mode.subsets; ++s) {
        const auto at = static_cast<std::size_t>(s);
        anchors[at] = bc7_anchor(mode.subsets, block.partition, s);
        clear_anchor(block.lines[at], anchors[at], mode.index_bits);
    }
    if (mode.second_index_bits > 0) {
        clear_anchor(block.alpha, 0, mode.second_index_bits);
    }
    put_endpoints(bits, block, mode);
    for (int i = 0; i < 16; ++i) {
        const auto s = static_cast<std::size_t>(bc7_subset(mode.subsets, block.partition, i));
        bits.put(
            block.lines[s].indices[static_cast<std::size_t>(i)],
            mode.index_bits - (i == anchors[s] ? 1 : 0));
    }
    for (int i = 0; i < 16 && mode.second_index_bits > 0; ++i) {
        bits.put(
            block.alpha.indices[static_cast<std::size_t>(i)],
            mode.second_index_bits - (i == 0 ? 1 : 0));
    }
    return bits.block();
}

void try_mode6(const BlockColors& texels, bool opaque, Bc7Block& best) {
    Bc7Block block;
    block.lines[0] = fit_line(
        texels, kAllTexels, {.bits = 8, .index_bits = 4, .pbits = true, .high_pbits = opaque},
        best.error);
    block.error = block.lines[0].error;
    keep_better(best, block);
}

/// With the channel `rotation` - 1 in place of alpha, and alpha in its place.
void try_mode5(BlockColors texels, int rotation, Bc7Block& best) {
    if (rotation > 0) {
        for (Vec4& texel : texels) {
            std::swap(texel.w, texel[rotation - 1]);
        }
    }
    Bc7Block block;
    block.mode = 5;
    block.rotation = rotation;
    block.alpha = fit_line(
        texels, kAllTexels, {.first = 3, .count = 1, .bits = 8, .index_bits = 2}, best.error);
    if (block.alpha.error < best.error) {
        block.lines[0] = fit_line(
            texels, kAllTexels, {.count = 3, .bits = 7, .index_bits = 2},
            best.error - block.alpha.error);
        block.error = block.lines[0].error + block.alpha.error;
        keep_better(best, block);
    }
}

std::uint32_t second_subset(int partition) {
    std::uint32_t texels = 0;
    for (int i = 0; i < 16; ++i) {
        texels |= static_cast<std::uint32_t>(bc7_subset(2, partition, i)) << i;
    }
    return texels;
}

/// Sums of colors and of their products, of which the variance off the principal axis follows.
struct ColorSums {
    float count = 0;
    Vec3 sum = {};
    Vec3 squares = {};
    Vec3 products = {};  ///< green blue, blue red, red green

    void add(const Vec3& c) {
        count += 1;
        sum += c;
        squares += c * c;
        products += Vec3(c.y * c.z, c.z * c.x, c.x * c.y);
    }
    [[nodiscard]] float off_axis() const {
        const Vec3 s = squares - sum * sum / count;
        const Vec3 p = products - Vec3(sum.y * sum.z, sum.z * sum.x, sum.x * sum.y) / count;
        const auto times = [&](const Vec3& v) {
            return Vec3(
                s.x * v.x + p.z * v.y + p.y * v.z, p.z * v.x + s.y * v.y + p.x * v.z,
                p.y * v.x + p.x * v.y + s.z * v.z);
        };
        Vec3 axis = s.x > s.y && s.x > s.z ? times({1, 0, 0})
                    : s.y > s.z            ? times({0, 1, 0})
                                           : times({0, 0, 1});
        for (int step = 0; step < 3; ++step) {
            const float scale =
                std::max(std::max(std::abs(axis.x), std::abs(axis.y)), std::abs(axis.z));
            if (scale < 1e-6f) {
                return 0;
            }
            axis = times(axis / scale);
        }
        const float square = glm::dot(axis, axis);
        const float along = square > 0 ? glm::dot(axis, times(axis)) / square : 0.0f;
        return std::max(s.x + s.y + s.z - along, 0.0f);
    }
};

/// The partitions in which the colors of both subsets are nearest to lines, the best first.
std::array<int, kTriedPartitions> best_partitions(const BlockColors& texels) {
    std::array<int, kTriedPartitions> best = {};
    std::array<float, kTriedPartitions> errors;
    errors.fill(std::numeric_limits<float>::max());
    for (int partition = 0; partition < 64; ++partition) {
        std::array<ColorSums, 2> sums;
        for (std::size_t i = 0; i < 16; ++i) {
            sums[static_cast<std::size_t>(bc7_subset(2, partition, static_cast<int>(i)))].add(
                Vec3(texels[i]));
        }
        float error = sums[0].off_axis() + sums[1].off_axis();
        int number = partition;
        for (std::size_t k = 0; k < best.size(); ++k) {
            if (error < errors[k]) {
                std::swap(error, errors[k]);
                std::swap(number, best[k]);
            }
        }
    }
    return best;
}

void try_mode1(const BlockColors& texels, int partition, Bc7Block& best) {
    Bc7Block block;
    block.mode = 1;
    block.partition = partition;
    const std::uint32_t second = second_subset(partition);
    const LineFormat format = {
        .count = 3, .bits = 7, .index_bits = 3, .pbits = true, .one_pbit = true};
    block.lines[0] = fit_line(texels, kAllTexels & ~second, format, best.error);
    if (block.lines[0].error < best.error) {
        block.lines[1] = fit_line(texels, second, format, best.error - block.lines[0].error);
        block.error = block.lines[0].error + block.lines[1].error;
        keep_better(best, block);
    }
}

/// One channel of BC5.
struct Bc4Fit {
    int first = 0;
    int second = 0;
    std::uint64_t indices = 0;
    float error = std::numeric_limits<float>::max();
};

using ChannelTexels = std::array<float, 16>;

Bc4Fit fit_indices(const ChannelTexels& texels, int first, int second) {
    Bc4Fit fit = {first, second, 0, 0};
    const int steps = first > second ? 7 : 5;
    std::array<float, 8> palette = {
        static_cast<float>(first), static_cast<float>(second), 0, 0, 0, 0, 0, 255};
    for (int i = 1; i < steps; ++i) {
        palette[static_cast<std::size_t>(i + 1)] =
            static_cast<float>((steps - i) * first + i * second) / static_cast<float>(steps);
    }
    for (std::size_t i = 0; i < texels.size(); ++i) {
        std::size_t nearest = 0;
        float least = std::numeric_limits<float>::max();
        for (std::size_t k = 0; k < palette.size(); ++k) {
            const float d = texels[i] - palette[k];
            if (d * d < least) {
                least = d * d;
                nearest = k;
            }
        }
        fit.indices |= std::uint64_t{nearest} << (3 * i);
        fit.error += least;
    }
    return fit;
}

/// Endpoints within 2 of the range of the texels, and 0 and 255 of their own where those occur.
Bc4Fit fit_channel(const ChannelTexels& texels) {
    const auto [least, largest] = std::minmax_element(texels.begin(), texels.end());
    const int low = static_cast<int>(*least + 0.5f);
    const int high = static_cast<int>(*largest + 0.5f);
    Bc4Fit best;
    const auto keep = [&](int first, int second) {
        const Bc4Fit fit =
            fit_indices(texels, std::clamp(first, 0, 255), std::clamp(second, 0, 255));
        best = fit.error < best.error ? fit : best;
    };
    for (int up = -1; up <= 2 && best.error > 0; ++up) {
        for (int down = -1; down <= 2; ++down) {
            keep(high - down, low + up);
        }
    }
    if (low == 0 || high == 255) {
        int inner_low = 255;
        int inner_high = 0;
        for (const float value : texels) {
            const int code = static_cast<int>(value + 0.5f);
            if (code > 0 && code < 255) {
                inner_low = std::min(inner_low, code);
                inner_high = std::max(inner_high, code);
            }
        }
        keep(std::min(inner_low, inner_high), std::max(inner_low, inner_high));
    }
    return best;
}

void write_channel(const ChannelTexels& texels, std::uint8_t* half) {
    const Bc4Fit fit = fit_channel(texels);
    half[0] = static_cast<std::uint8_t>(fit.first);
    half[1] = static_cast<std::uint8_t>(fit.second);
    for (int i = 0; i < 6; ++i) {
        half[2 + i] = static_cast<std::uint8_t>(fit.indices >> (8 * i));
    }
}

}  // namespace

BlockBytes encode_bc7(const BlockColors& texels) {
    const bool opaque = std::all_of(
        texels.begin(), texels.end(), [](const Vec4& texel) { return texel.w >= 255.0f; });
    Bc7Block best;
    try_mode6(texels, opaque, best);
    for (int rotation = opaque ? 1 : 0; rotation < 4 && best.error > kGoodBlock; ++rotation) {
        try_mode5(texels, rotation, best);
    }
    if (opaque && best.error > kGoodBlock) {
        for (const int partition : best_partitions(texels)) {
            try_mode1(texels, partition, best);
        }
    }
    return write_block(best);
}

BlockBytes encode_bc5(const BlockColors& texels) {
    BlockBytes block = {};
    for (int c = 0; c < 2; ++c) {
        ChannelTexels channel;
        for (std::size_t i = 0; i < channel.size(); ++i) {
            channel[i] = texels[i][c];
        }
        write_channel(channel, block.data() + 8 * c);
    }
    return block;
}

}  // namespace limn
