#pragma once

#include "ecs/components/surface.h"

#include <cstdint>
#include <vector>

namespace limn {

// The fully transparent margins of the frames of a flipbook, by which quads are trimmed: sprites
// are bound by fill rate, and blending transparent texels is wasted.
// After E. Persson, "Particle Trimmer", 2009, with rectangles.

/// In units of 1 / kInsetSteps of the frame, 0 .. kInsetSteps / 2 - 1.
struct FrameInsets {
    std::uint32_t left = 0;
    std::uint32_t bottom = 0;
    std::uint32_t right = 0;
    std::uint32_t top = 0;

    bool operator==(const FrameInsets&) const = default;
};

/// Of frame number `frame`, counted row by row from the top left, of columns x rows. All texels
/// that contribute under bilinear filtering stay. No insets for images that are not of format
/// Rgba8, or that `columns` and `rows` do not divide.
[[nodiscard]] FrameInsets
find_insets(const ImageData& image, std::uint32_t columns, std::uint32_t rows, std::uint32_t frame);

/// The encoding of look records (particle_gpu.h): exact in a float.
[[nodiscard]] float pack_insets(const FrameInsets& insets);

/// Insets of flipbooks, found once for each.
class FrameInsetTable {
  public:
    /// Clears the table if the assets are others than before.
    void use_assets(std::uint64_t identity);
    /// Packed insets of each frame; valid until the next call. Empty if there are more frames than
    /// kMaxInsetFrames.
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
