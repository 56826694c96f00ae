#pragma once

#include <optional>
#include <vector>

namespace limn {

/// A square of the atlas [texels].
struct AtlasRect {
    int x = 0;
    int y = 0;
    int size = 0;
    bool operator==(const AtlasRect&) const = default;
};

/// Allocates squares whose sides are powers of two: a two-dimensional buddy allocator. A square
/// does not move until it is released; four free siblings are merged.
class ShadowAtlas {
  public:
    /// `size`: a power of two.
    explicit ShadowAtlas(int size);

    /// A square of side `size`, a power of two; nullopt if none is free.
    [[nodiscard]] std::optional<AtlasRect> allocate(int size);
    void release(const AtlasRect& rect);
    /// Doubles the side; allocated squares stay where they are.
    void grow();

    [[nodiscard]] int size() const { return size_; }

  private:
    [[nodiscard]] std::vector<AtlasRect>& free_of(int size);

    int size_;
    std::vector<std::vector<AtlasRect>> free_;  ///< by log2 of the side
};

}  // namespace limn
