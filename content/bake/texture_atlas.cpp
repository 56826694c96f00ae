#include "content/bake/texture_atlas.h"

#include "ecs/base/jobs.h"
#include "ecs/base/srgb.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

// Techniques: engine.texture-atlas

namespace limn {
namespace {

constexpr float kGutterCell = 512;  // for which lay_out_atlas() takes the gutter [px]

int inner_size(const AtlasLayout& layout) {
    return layout.cell - 2 * layout.gutter;
}

/// Bytes of color or data as what is averaged.
std::array<float, 256> value_table(bool srgb) {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float value = static_cast<float>(i) / 255;
        values[i] = srgb ? linear_from_srgb(value) : value;
    }
    return values;
}

/// A texel, and how much it counts.
struct Tap {
    int texel = 0;
    double weight = 0;
};

/// What pixel `i` of `size` reads of a row of `count` texels stretched over it: the mean of what it
/// covers where that is a texel or more, else the two about its center.
std::vector<Tap> taps_of(std::size_t i, int size, int count) {
    const double step = static_cast<double>(count) / size;
    const double from = static_cast<double>(i) * step;
    std::vector<Tap> taps;
    if (step < 1) {
        const double center = std::clamp(from + 0.5 * step - 0.5, 0.0, count - 1.0);
        const int low = std::min(static_cast<int>(center), std::max(count - 2, 0));
        taps = {{low, 1 - (center - low)}, {std::min(low + 1, count - 1), center - low}};
        return taps;
    }
    for (int texel = static_cast<int>(from); texel < count && texel < from + step; ++texel) {
        const double covered =
            std::min<double>(from + step, texel + 1) - std::max<double>(from, texel);
        taps.push_back({texel, covered / step});
    }
    return taps;
}

/// A texture stretched over a square of `size` pixels.
std::vector<std::uint8_t> stretched(const ImageData& texture, int size) {
    if (texture.width == size && texture.height == size) {
        return texture.pixels;
    }
    const std::array<float, 256> color = value_table(texture.srgb);
    const std::array<float, 256> data = value_table(false);
    std::vector<std::vector<Tap>> across;
    for (int x = 0; x < size; ++x) {
        across.push_back(taps_of(static_cast<std::size_t>(x), size, texture.width));
    }
    const auto columns = static_cast<std::size_t>(size);
    std::vector<std::uint8_t> pixels(4 * columns * columns);
    parallel_for(columns, 16, [&](std::size_t begin, std::size_t end) {
        std::vector<Tap> down;
        for (std::size_t i = begin * columns; i < end * columns; ++i) {
            if (i % columns == 0) {
                down = taps_of(i / columns, size, texture.height);
            }
            std::array<double, 4> sum{};
            for (const Tap& row : down) {
                for (const Tap& column : across[i % columns]) {
                    const std::uint8_t* const texel =
                        &texture.pixels
                             [4
                              * static_cast<std::size_t>(row.texel * texture.width + column.texel)];
                    for (std::size_t c = 0; c < 4; ++c) {
                        sum[c] += row.weight * column.weight
                                  * static_cast<double>((c < 3 ? color : data)[texel[c]]);
                    }
                }
            }
            for (std::size_t c = 0; c < 4; ++c) {
                const auto mean = static_cast<float>(sum[c]);
                const float stored = texture.srgb && c < 3 ? srgb_from_linear(mean) : mean;
                pixels[4 * i + c] =
                    static_cast<std::uint8_t>(std::lround(255 * std::clamp(stored, 0.0f, 1.0f)));
            }
        }
    });
    return pixels;
}

}  // namespace

AtlasLayout lay_out_atlas(std::size_t textures, int largest, int max_size, float gutter) {
    AtlasLayout layout;
    const int count = static_cast<int>(std::max<std::size_t>(textures, 1));
    layout.columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
    layout.rows = (count + layout.columns - 1) / layout.columns;
    layout.cell = static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(largest, 1))));
    while (layout.cell > 1 && layout.columns * layout.cell > max_size) {
        layout.cell /= 2;
    }
    const float scaled = gutter * static_cast<float>(layout.cell) / kGutterCell;
    layout.gutter = std::min(static_cast<int>(std::ceil(scaled)), layout.cell / 4);
    return layout;
}

AtlasCell atlas_cell(const AtlasLayout& layout, std::size_t cell) {
    const auto columns = static_cast<std::size_t>(layout.columns);
    const Vec2 first = Vec2(cell % columns, cell / columns) * static_cast<float>(layout.cell);
    const float inset = layout.gutter > 0 ? static_cast<float>(layout.gutter) : 0.5f;
    const Vec2 size = Vec2(layout.columns, layout.rows) * static_cast<float>(layout.cell);
    return {(first + inset) / size, Vec2(static_cast<float>(layout.cell) - 2 * inset) / size};
}

int last_atlas_level(const AtlasLayout& layout) {
    const int side = layout.gutter > 0 ? 2 * layout.gutter : layout.cell;
    return std::bit_width(static_cast<unsigned>(side)) - 1;
}

ImageData make_atlas(const AtlasLayout& layout, std::span<const ImageData* const> textures) {
    ImageData atlas;
    atlas.width = layout.columns * layout.cell;
    atlas.height = layout.rows * layout.cell;
    const auto row_bytes = 4 * static_cast<std::size_t>(atlas.width);
    atlas.pixels.assign(row_bytes * static_cast<std::size_t>(atlas.height), 255);
    const int inner = inner_size(layout);
    for (std::size_t i = 0; i < textures.size(); ++i) {
        if (textures[i] == nullptr) {
            continue;
        }
        atlas.srgb = textures[i]->srgb;
        const std::vector<std::uint8_t> pixels = stretched(*textures[i], inner);
        const auto columns = static_cast<std::size_t>(layout.columns);
        const auto cell = static_cast<std::size_t>(layout.cell);
        std::uint8_t* const first =
            &atlas.pixels[i / columns * cell * row_bytes + 4 * (i % columns * cell)];
        for (int y = 0; y < layout.cell; ++y) {
            for (int x = 0; x < layout.cell; ++x) {
                const int from_x = std::clamp(x - layout.gutter, 0, inner - 1);
                const int from_y = std::clamp(y - layout.gutter, 0, inner - 1);
                std::memcpy(
                    first + static_cast<std::size_t>(y) * row_bytes + 4 * x,
                    &pixels[4 * static_cast<std::size_t>(from_y * inner + from_x)], 4);
            }
        }
    }
    return atlas;
}

}  // namespace limn
