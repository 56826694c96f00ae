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

/// Calls `add` with each of `count` rows or columns in [from, to), and how much of it is there.
template <typename Add>
void for_covered(double from, double to, int count, Add add) {
    for (int i = static_cast<int>(from); i < count && i < to; ++i) {
        add(i, std::min<double>(to, i + 1) - std::max<double>(from, i));
    }
}

/// A texture stretched over a square of `size` pixels.
std::vector<std::uint8_t> stretched(const ImageData& texture, int size) {
    if (texture.width == size && texture.height == size) {
        return texture.pixels;
    }
    const std::array<float, 256> color = value_table(texture.srgb);
    const std::array<float, 256> data = value_table(false);
    const double step_x = static_cast<double>(texture.width) / size;
    const double step_y = static_cast<double>(texture.height) / size;
    const auto columns = static_cast<std::size_t>(size);
    std::vector<std::uint8_t> pixels(4 * columns * columns);
    parallel_for(columns, 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * columns; i < end * columns; ++i) {
            const auto x = static_cast<double>(i % columns);
            const auto y = static_cast<double>(i / columns);
            std::array<double, 4> sum{};
            for_covered(y * step_y, (y + 1) * step_y, texture.height, [&](int row, double down) {
                for_covered(x * step_x, (x + 1) * step_x, texture.width, [&](int at, double wide) {
                    const std::uint8_t* const texel =
                        &texture.pixels[4 * static_cast<std::size_t>(row * texture.width + at)];
                    for (std::size_t c = 0; c < 4; ++c) {
                        sum[c] +=
                            down * wide * static_cast<double>((c < 3 ? color : data)[texel[c]]);
                    }
                });
            });
            for (std::size_t c = 0; c < 4; ++c) {
                const auto mean = static_cast<float>(sum[c] / (step_x * step_y));
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
    return std::bit_width(static_cast<unsigned>(layout.cell)) - 1;
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
