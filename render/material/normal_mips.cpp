#include "render/material/normal_mips.h"

#include "ecs/base/math.h"

#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

// Techniques: bump.mipmap

namespace limn {
namespace {

constexpr float kMinNormalZ = 0.1f;  // of the normals whose slopes are taken

/// Means over the texels of the image that a texel of a level covers.
struct MeanBump {
    Vec4 normal = {};  // w: alpha of the image
    Vec2 slope = {};
    Vec3 square = {};  // of the slopes, and their product
};

struct BumpLevel {
    int width = 0;
    int height = 0;
    std::vector<MeanBump> texels;
};

/// Texels of a row of `size` that the texel `at` of a row of `coarse` covers: three at most.
struct CoveredTexels {
    int first = 0;
    int count = 0;
    std::array<float, 3> share = {};
};

CoveredTexels covered(int at, int size, int coarse) {
    const double scale = static_cast<double>(size) / coarse;
    const double begin = at * scale;
    const double end = (at + 1) * scale;
    CoveredTexels texels = {.first = static_cast<int>(begin + 1e-6)};
    for (int i = texels.first; i < size && i < end - 1e-6 && texels.count < 3; ++i) {
        const double part = std::min(i + 1.0, end) - std::max<double>(i, begin);
        texels.share[static_cast<std::size_t>(texels.count++)] = static_cast<float>(part / scale);
    }
    return texels;
}

void add_bump(MeanBump& sum, const MeanBump& texel, float share) {
    sum.normal += share * texel.normal;
    sum.slope += share * texel.slope;
    sum.square += share * texel.square;
}

/// `read(x, y)`: the MeanBump of a texel of the finer level.
template <typename Read>
BumpLevel coarser_bumps(int width, int height, const Read& read) {
    BumpLevel level = {std::max(width / 2, 1), std::max(height / 2, 1), {}};
    level.texels.reserve(static_cast<std::size_t>(level.width * level.height));
    for (int y = 0; y < level.height; ++y) {
        const CoveredTexels rows = covered(y, height, level.height);
        for (int x = 0; x < level.width; ++x) {
            const CoveredTexels columns = covered(x, width, level.width);
            MeanBump& mean = level.texels.emplace_back();
            for (int j = 0; j < rows.count; ++j) {
                for (int i = 0; i < columns.count; ++i) {
                    add_bump(
                        mean, read(columns.first + i, rows.first + j),
                        columns.share[static_cast<std::size_t>(i)]
                            * rows.share[static_cast<std::size_t>(j)]);
                }
            }
        }
    }
    return level;
}

/// Four channels of a texel, 0 .. 1 in integer formats.
Vec4 decoded(PixelFormat format, const std::uint8_t* texel) {
    switch (format) {
    case PixelFormat::Rgba8:
        return Vec4(texel[0], texel[1], texel[2], texel[3]) / 255.0f;
    case PixelFormat::Rgba16F: {
        std::array<std::uint16_t, 4> halves = {};
        std::memcpy(halves.data(), texel, sizeof halves);
        return {
            glm::unpackHalf1x16(halves[0]), glm::unpackHalf1x16(halves[1]),
            glm::unpackHalf1x16(halves[2]), glm::unpackHalf1x16(halves[3])};
    }
    case PixelFormat::Rgba32F:
        break;
    case PixelFormat::Bc5:
    case PixelFormat::Bc7:
        return {};
    }
    Vec4 value;
    std::memcpy(&value, texel, sizeof value);
    return value;
}

template <typename T>
void append_bytes(std::vector<std::uint8_t>& bytes, const T& value) {
    std::array<std::uint8_t, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    bytes.insert(bytes.end(), raw.begin(), raw.end());
}

void append_rgba8(std::vector<std::uint8_t>& bytes, const Vec4& texel) {
    for (int c = 0; c < 4; ++c) {
        bytes.push_back(
            static_cast<std::uint8_t>(std::clamp(texel[c], 0.0f, 1.0f) * 255.0f + 0.5f));
    }
}

void append_texel(std::vector<std::uint8_t>& bytes, PixelFormat format, const Vec4& texel) {
    switch (format) {
    case PixelFormat::Rgba8:
        append_rgba8(bytes, texel);
        break;
    case PixelFormat::Rgba16F:
        for (int c = 0; c < 4; ++c) {
            append_bytes(bytes, glm::packHalf1x16(texel[c]));
        }
        break;
    case PixelFormat::Rgba32F:
        append_bytes(bytes, texel);
        break;
    case PixelFormat::Bc5:
    case PixelFormat::Bc7:
        break;
    }
}

/// Up where there is no direction: also of NaN.
Vec3 unit_or_up(const Vec3& v) {
    const float length = glm::length(v);
    return length > 1e-3f && std::isfinite(length) ? v / length : Vec3(0, 0, 1);
}

MeanBump bump_of(const Vec4& texel) {
    const Vec3 n = unit_or_up(Vec3(texel) * 2.0f - 1.0f);
    const Vec2 slope = Vec2(n) / std::max(n.z, kMinNormalZ);
    const float alpha = std::isfinite(texel.w) ? texel.w : 0.0f;
    return {Vec4(n, alpha), slope, {slope.x * slope.x, slope.y * slope.y, slope.x * slope.y}};
}

/// Variances of the slopes, and their covariance.
Vec3 variances(const MeanBump& mean, NormalMips mips) {
    if (mips == NormalMips::Toksvig) {
        const float length = std::clamp(glm::length(Vec3(mean.normal)), 1e-3f, 1.0f);
        const float variance = (1 - length) / length;
        return {variance, variance, 0};
    }
    const Vec2& b = mean.slope;
    return mean.square - Vec3(b.x * b.x, b.y * b.y, b.x * b.y);
}

Vec4 encoded_spread(const Vec3& variances) {
    const Vec2 deviation = glm::sqrt(glm::max(Vec2(variances), Vec2(0)));
    const float product = deviation.x * deviation.y;
    const float correlation = product > 1e-8f ? variances.z / product : 0.0f;
    return {deviation, 0.5f * std::clamp(correlation, -1.0f, 1.0f) + 0.5f, 1};
}

NormalLevel encoded(const BumpLevel& level, PixelFormat format, NormalMips mips) {
    NormalLevel stored;
    for (const MeanBump& mean : level.texels) {
        // The mean slope is the first moment of LEAN mapping.
        const Vec3 direction = mips == NormalMips::Lean ? Vec3(mean.slope, 1) : Vec3(mean.normal);
        append_texel(
            stored.normals, format, Vec4(unit_or_up(direction) * 0.5f + 0.5f, mean.normal.w));
        if (mips != NormalMips::Plain) {
            append_rgba8(stored.spread, encoded_spread(variances(mean, mips)));
        }
    }
    return stored;
}

}  // namespace

std::vector<NormalLevel> make_normal_levels(const ImageData& image, NormalMips mips) {
    std::vector<NormalLevel> levels(1);
    const auto width = static_cast<std::size_t>(image.width);
    if (mips != NormalMips::Plain) {
        const std::size_t texels = width * static_cast<std::size_t>(image.height);
        for (std::size_t i = 0; i < texels; ++i) {
            append_rgba8(levels[0].spread, encoded_spread(Vec3(0)));
        }
    }
    const std::size_t bytes = image.format == PixelFormat::Rgba8     ? 4
                              : image.format == PixelFormat::Rgba16F ? 8
                                                                     : 16;
    BumpLevel level = {image.width, image.height, {}};
    while (level.width > 1 || level.height > 1) {
        if (level.texels.empty()) {
            level = coarser_bumps(level.width, level.height, [&](int x, int y) {
                const std::size_t at =
                    static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
                return bump_of(decoded(image.format, image.pixels.data() + bytes * at));
            });
        } else {
            level =
                coarser_bumps(level.width, level.height, [&level](int x, int y) -> const MeanBump& {
                    return level.texels[static_cast<std::size_t>(y * level.width + x)];
                });
        }
        levels.push_back(encoded(level, image.format, mips));
    }
    return levels;
}

}  // namespace limn
