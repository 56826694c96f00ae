#include "render/particles/frame_insets.h"

#include "render/shaders/particle_gpu.h"

#include <algorithm>

namespace limn {
namespace {

constexpr std::uint32_t kMaxInset = layout::kInsetSteps / 2 - 1;

/// Inset for `texels` transparent texels of `side`: the one next to the content stays, for bilinear
/// filtering.
std::uint32_t inset_of(int texels, int side) {
    const int steps = std::max(texels - 1, 0) * static_cast<int>(layout::kInsetSteps) / side;
    return std::min(static_cast<std::uint32_t>(steps), kMaxInset);
}

}  // namespace

FrameInsets find_insets(
    const ImageData& image, std::uint32_t columns, std::uint32_t rows, std::uint32_t frame) {
    const int across = static_cast<int>(columns);
    const int down = static_cast<int>(rows);
    const auto texels =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    if (image.format != PixelFormat::Rgba8 || across < 1 || down < 1 || image.width % across != 0
        || image.height % down != 0 || image.pixels.size() != 4 * texels) {
        return {};
    }
    const int width = image.width / across;
    const int height = image.height / down;
    const int first_x = static_cast<int>(frame) % across * width;
    const int first_y = static_cast<int>(frame) / across * height;
    int left = width;
    int right = width;
    int top = height;
    int bottom = height;
    for (int y = 0; y < height; ++y) {
        const std::uint8_t* const row =
            &image.pixels[4 * (static_cast<std::size_t>(first_y + y) * image.width + first_x)];
        for (int x = 0; x < width; ++x) {
            if (row[4 * x + 3] != 0) {
                left = std::min(left, x);
                right = std::min(right, width - 1 - x);
                top = std::min(top, y);
                bottom = std::min(bottom, height - 1 - y);
            }
        }
    }
    return {
        inset_of(left, width), inset_of(bottom, height), inset_of(right, width),
        inset_of(top, height)};
}

float pack_insets(const FrameInsets& insets) {
    constexpr std::uint32_t kBase = layout::kInsetSteps / 2;
    return static_cast<float>(
        insets.left + kBase * (insets.bottom + kBase * (insets.right + kBase * insets.top)));
}

void FrameInsetTable::use_assets(std::uint64_t identity) {
    if (identity != assets_) {
        books_.clear();
        assets_ = identity;
    }
}

const std::vector<float>& FrameInsetTable::find(
    const ImageData& image, ImageId id, std::uint32_t columns, std::uint32_t rows) {
    const auto is_same = [&](const Book& book) {
        return book.image == id && book.columns == columns && book.rows == rows;
    };
    const auto found = std::find_if(books_.begin(), books_.end(), is_same);
    if (found != books_.end()) {
        return found->insets;
    }
    Book& book = books_.emplace_back(Book{.image = id, .columns = columns, .rows = rows});
    const std::uint64_t count = std::uint64_t{columns} * rows;
    for (std::uint32_t i = 0; count <= layout::kMaxInsetFrames && i < count; ++i) {
        book.insets.push_back(pack_insets(find_insets(image, columns, rows, i)));
    }
    return book.insets;
}

}  // namespace limn
