#pragma once

#include "render/gpu/buffer.h"
#include "render/gpu/fence.h"
#include "render/gpu/texture.h"

#include <deque>
#include <optional>
#include <vector>

namespace limn::gpu {

// Reads textures back to the CPU. The first pixel is the top left one, as in image files; OpenGL
// starts at the bottom.

struct FloatImage {
    int width = 0;
    int height = 0;
    int channels = 0;
    std::vector<float> pixels;  ///< channel c of (x, y) is at (y * width + x) * channels + c

    [[nodiscard]] float at(int x, int y, int c) const {
        return pixels[(static_cast<std::size_t>(y) * width + x) * channels + c];
    }
};

struct ByteImage {
    int width = 0;
    int height = 0;
    int channels = 0;
    std::vector<std::uint8_t> pixels;  ///< as FloatImage

    [[nodiscard]] std::uint8_t at(int x, int y, int c) const {
        return pixels[(static_cast<std::size_t>(y) * width + x) * channels + c];
    }
};

/// Waits for the GPU. Normalized formats become 0 .. 1, integers keep their value, depth-stencil
/// gives its depth. `layer` is a face of a cube, a layer of an array or a slice of a volume. Not
/// for multisampled textures.
[[nodiscard]] FloatImage read_floats(const Texture& texture, int level = 0, int layer = 0);

/// The same as bytes, of normalized formats: 1.0 becomes 255. sRGB formats give their encoded
/// bytes.
[[nodiscard]] ByteImage read_bytes(const Texture& texture, int level = 0, int layer = 0);

/// Reads level 0 of 2D textures back without waiting: request() now, poll() in some later frame.
class AsyncReadback {
  public:
    void request(const Texture& texture);
    /// The oldest requested image once it is available, in the order of the requests.
    [[nodiscard]] std::optional<ByteImage> poll();
    [[nodiscard]] std::size_t pending() const { return pending_.size(); }

  private:
    struct Transfer {
        Buffer buffer;
        Fence fence;
        int width = 0;
        int height = 0;
        int channels = 0;
    };
    std::deque<Transfer> pending_;
    std::vector<Buffer> spare_;
};

}  // namespace limn::gpu
