#include "content/bake/block_image.h"

#include "content/bake/block_encode.h"
#include "ecs/base/check.h"
#include "ecs/base/srgb.h"
#include "ecs/components/image_blocks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

// Techniques: engine.opt-texture

namespace limn {
namespace {

/// Means of the image over the texels of a level: linear color, unit vector or value, and alpha.
struct MeanLevel {
    int width = 0;
    int height = 0;
    std::vector<Vec4> texels;

    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width)
               + static_cast<std::size_t>(x);
    }
};

/// Texels of a row that one of the next level covers: two, or three of an odd row.
struct TexelSpan {
    int first = 0;
    std::array<float, 3> share = {};
};

TexelSpan covered_texels(int at, int size) {
    const int coarse = std::max(size / 2, 1);
    if (size % 2 == 0 || size == 1) {
        return {2 * at, {size == 1 ? 1.0f : 0.5f, size == 1 ? 0.0f : 0.5f, 0}};
    }
    // [at, at + 1) * size / coarse, of size = 2 coarse + 1
    const float whole = static_cast<float>(coarse);
    const float total = static_cast<float>(size);
    return {
        2 * at,
        {(whole - static_cast<float>(at)) / total, whole / total,
         static_cast<float>(at + 1) / total}};
}

class TexelReading {
  public:
    explicit TexelReading(TexelKind kind) : kind_(kind) {
        for (std::size_t code = 0; code < linear_.size(); ++code) {
            linear_[code] = linear_from_srgb(static_cast<float>(code) / 255.0f);
        }
    }

    [[nodiscard]] Vec4 operator()(const std::uint8_t* rgba) const {
        if (kind_ == TexelKind::Color) {
            return {
                linear_[rgba[0]], linear_[rgba[1]], linear_[rgba[2]],
                static_cast<float>(rgba[3]) / 255.0f};
        }
        const Vec4 value = Vec4(rgba[0], rgba[1], rgba[2], rgba[3]) / 255.0f;
        return kind_ == TexelKind::Normal ? Vec4(unit_of(2.0f * Vec3(value) - 1.0f), value.w)
                                          : value;
    }

    /// Of a mean, 0 .. 255.
    [[nodiscard]] Vec4 encoded(const Vec4& mean) const {
        Vec4 value = mean;
        if (kind_ == TexelKind::Color) {
            for (int c = 0; c < 3; ++c) {
                value[c] = srgb_from_linear(mean[c]);
            }
        } else if (kind_ == TexelKind::Normal) {
            value = Vec4(0.5f * unit_of(Vec3(mean)) + 0.5f, mean.w);
        }
        return glm::clamp(255.0f * value, Vec4(0), Vec4(255));
    }

  private:
    /// Up where there is no direction.
    static Vec3 unit_of(const Vec3& v) {
        const float length = glm::length(v);
        return length > 1e-3f ? v / length : Vec3(0, 0, 1);
    }

    TexelKind kind_;
    std::array<float, 256> linear_ = {};
};

/// `read(x, y)`: a texel of the finer level.
template <typename Read>
MeanLevel coarser_level(int width, int height, const Read& read) {
    MeanLevel level = {std::max(width / 2, 1), std::max(height / 2, 1), {}};
    level.texels.resize(
        static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height));
    bake_rows(level.height, {}, [&](int y) {
        const TexelSpan rows = covered_texels(y, height);
        for (int x = 0; x < level.width; ++x) {
            const TexelSpan columns = covered_texels(x, width);
            Vec4 mean(0);
            for (int j = 0; j < 3; ++j) {
                for (int i = 0; i < 3; ++i) {
                    const float share = columns.share[static_cast<std::size_t>(i)]
                                        * rows.share[static_cast<std::size_t>(j)];
                    if (share > 0) {
                        mean += share * read(columns.first + i, rows.first + j);
                    }
                }
            }
            level.texels[level.index(x, y)] = mean;
        }
    });
    return level;
}

/// Appends the blocks of a level; `texel(x, y)`: 0 .. 255.
template <typename Texel>
void append_level(
    ImageData& to, int width, int height, const RowProgress& progress, const Texel& texel) {
    const int columns = (width + kBlockSide - 1) / kBlockSide;
    const int rows = (height + kBlockSide - 1) / kBlockSide;
    const std::size_t begin = to.pixels.size();
    to.pixels.resize(
        begin + static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) * kBlockBytes);
    bake_rows(rows, progress, [&](int row) {
        for (int column = 0; column < columns; ++column) {
            BlockColors colors;
            for (int i = 0; i < 16; ++i) {
                // beyond the edge its last texels again
                colors[static_cast<std::size_t>(i)] = texel(
                    std::min(column * kBlockSide + i % kBlockSide, width - 1),
                    std::min(row * kBlockSide + i / kBlockSide, height - 1));
            }
            const BlockBytes block =
                to.format == PixelFormat::Bc5 ? encode_bc5(colors) : encode_bc7(colors);
            const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns)
                            + static_cast<std::size_t>(column);
            std::memcpy(&to.pixels[begin + at * kBlockBytes], block.data(), block.size());
        }
    });
}

}  // namespace

int block_rows(int width, int height, bool levels) {
    int rows = 0;
    for (int level = 0; level < (levels ? max_mip_levels(width, height) : 1); ++level) {
        rows += (std::max(height >> level, 1) + kBlockSide - 1) / kBlockSide;
    }
    return rows;
}

ImageData
encode_blocks(const ImageData& image, const BlockOptions& options, const RowProgress& progress) {
    LIMN_CHECK(is_in_blocks(options.format) && image.format == PixelFormat::Rgba8);
    LIMN_CHECK(image.width > 0 && image.height > 0 && image.pixels.size() >= level_bytes(image, 0));
    const TexelReading reading(options.kind);
    const auto width = static_cast<std::size_t>(image.width);
    const auto bytes_at = [&](int x, int y) {
        return image.pixels.data()
               + 4 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x));
    };
    ImageData blocks;
    blocks.name = image.name;
    blocks.width = image.width;
    blocks.height = image.height;
    blocks.format = options.format;
    blocks.srgb = options.format == PixelFormat::Bc7 && options.kind == TexelKind::Color;
    int rows_before = 0;
    const RowProgress report = [&](int rows) {
        if (progress) {
            progress(rows_before + rows);
        }
    };
    append_level(blocks, image.width, image.height, report, [&](int x, int y) {
        const std::uint8_t* const rgba = bytes_at(x, y);
        return options.kind == TexelKind::Normal ? reading.encoded(reading(rgba))
                                                 : Vec4(rgba[0], rgba[1], rgba[2], rgba[3]);
    });
    MeanLevel level = {image.width, image.height, {}};
    while (options.levels && (level.width > 1 || level.height > 1)) {
        rows_before += (level.height + kBlockSide - 1) / kBlockSide;
        if (level.texels.empty()) {
            level = coarser_level(
                level.width, level.height, [&](int x, int y) { return reading(bytes_at(x, y)); });
        } else {
            const MeanLevel finer = std::move(level);
            level = coarser_level(finer.width, finer.height, [&finer](int x, int y) {
                return finer.texels[finer.index(x, y)];
            });
        }
        append_level(blocks, level.width, level.height, report, [&](int x, int y) {
            return reading.encoded(level.texels[level.index(x, y)]);
        });
        ++blocks.mip_levels;
    }
    return blocks;
}

}  // namespace limn
