#pragma once

#include "ecs/components/surface.h"

#include <cstdint>
#include <vector>

namespace limn {

// How much of the frames of a flipbook is fully transparent at their sides, so that quads are drawn
// without it: what they cover, and blend in vain, is most of what sprites cost.
// After E. Persson, "Particle Trimmer", 2009, with rectangles.

/// In units of 1 / kInsetSteps of the frame, 0 .. kInsetSteps / 2 - 1.
struct FrameInsets {
    std::uint32_t left = 0;
    std::uint32_t bottom = 0;
    std::uint32_t right = 0;
    std::uint32_t top = 0;

    bool operator==(const FrameInsets&) const = default;
};

/// Of the frame of number `frame`, row by row from the top left, of columns x rows. A texel that a
/// bilinear filter reads where the frame is not transparent stays. None of images that are not of
/// format Rgba8, or that `columns` and `rows` do not divide.
[[nodiscard]] FrameInsets
find_insets(const ImageData& image, std::uint32_t columns, std::uint32_t rows, std::uint32_t frame);

/// As a look record has them (particle_gpu.h): exact in a float.
[[nodiscard]] float pack_insets(const FrameInsets& insets);

/// Insets of flipbooks, found once for each.
class FrameInsetTable {
  public:
    /// Forgets those of other assets.
    void use_assets(std::uint64_t identity);
    /// Packed, of each frame; valid until the next call. Empty for more than kMaxInsetFrames.
    [[nodiscard]] const std::vector<float>&
    find(const ImageData& image, ImageId id, std::uint32_t columns, std::uint32_t rows);

  private:
    struct Book {
        ImageId image;
        std::uint32_t columns = 0;
        std::uint32_t rows = 0;
        std::vector<float> insets{};
    };
    std::uint64_t assets_ = 0;
    std::vector<Book> books_;
};

}  // namespace limn
