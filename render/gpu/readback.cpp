#include "render/gpu/readback.h"

#include "ecs/base/check.h"

#include <algorithm>

namespace limn::gpu {
namespace {

GLenum client_format(const FormatInfo& info, bool integer) {
    if (info.depth) {
        return GL_DEPTH_COMPONENT;
    }
    switch (info.channels) {
    case 1:
        return integer ? GL_RED_INTEGER : GL_RED;
    case 2:
        return integer ? GL_RG_INTEGER : GL_RG;
    case 3:
        return integer ? GL_RGB_INTEGER : GL_RGB;
    default:
        return integer ? GL_RGBA_INTEGER : GL_RGBA;
    }
}

/// Flips bottom row first to top row first.
template <typename T>
void flip_rows(std::vector<T>& pixels, std::size_t row, std::size_t rows) {
    for (std::size_t y = 0; y < rows / 2; ++y) {
        const auto low = pixels.begin() + static_cast<std::ptrdiff_t>(y * row);
        const auto high = pixels.begin() + static_cast<std::ptrdiff_t>((rows - 1 - y) * row);
        std::swap_ranges(low, low + static_cast<std::ptrdiff_t>(row), high);
    }
}

template <typename T>
std::vector<T>
read_layer(const Texture& texture, GLenum format, GLenum type, int channels, int level, int layer) {
    LIMN_CHECK(texture.desc().samples == 0);
    LIMN_CHECK(
        level >= 0 && level < texture.desc().levels && layer >= 0 && layer < texture.layers(level));
    const int width = texture.width(level);
    const int height = texture.height(level);
    const std::size_t row = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
    std::vector<T> pixels(row * static_cast<std::size_t>(height));
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureSubImage(
        texture.id(), level, 0, 0, layer, width, height, 1, format, type,
        static_cast<GLsizei>(pixels.size() * sizeof(T)), pixels.data());
    flip_rows(pixels, row, static_cast<std::size_t>(height));
    return pixels;
}

}  // namespace

FloatImage read_floats(const Texture& texture, int level, int layer) {
    const FormatInfo& info = format_info(texture.desc().format);
    FloatImage image{texture.width(level), texture.height(level), info.channels, {}};
    if (info.integer) {
        const std::vector<std::int32_t> numbers = read_layer<std::int32_t>(
            texture, client_format(info, true),
            info.pixel_type == GL_INT ? GL_INT : GL_UNSIGNED_INT, info.channels, level, layer);
        image.pixels.reserve(numbers.size());
        for (const std::int32_t number : numbers) {
            image.pixels.push_back(
                info.pixel_type == GL_INT ? static_cast<float>(number)
                                          : static_cast<float>(static_cast<std::uint32_t>(number)));
        }
    } else {
        image.pixels = read_layer<float>(
            texture, client_format(info, false), GL_FLOAT, info.channels, level, layer);
    }
    return image;
}

ByteImage read_bytes(const Texture& texture, int level, int layer) {
    const FormatInfo& info = format_info(texture.desc().format);
    LIMN_CHECK(!info.integer && !info.depth);
    return {
        texture.width(level), texture.height(level), info.channels,
        read_layer<std::uint8_t>(
            texture, client_format(info, false), GL_UNSIGNED_BYTE, info.channels, level, layer)};
}

void AsyncReadback::request(const Texture& texture) {
    const FormatInfo& info = format_info(texture.desc().format);
    LIMN_CHECK(!info.integer && !info.depth && texture.desc().samples == 0);
    const int width = texture.width();
    const int height = texture.height();
    const std::size_t bytes = static_cast<std::size_t>(width) * static_cast<std::size_t>(height)
                              * static_cast<std::size_t>(info.channels);
    Buffer buffer;
    const auto fits = std::find_if(
        spare_.begin(), spare_.end(), [&](const Buffer& b) { return b.size() == bytes; });
    if (fits != spare_.end()) {
        buffer = std::move(*fits);
    } else {
        buffer = Buffer("async readback", bytes, BufferUse::GpuOnly);
    }
    spare_.clear();  // other sizes are left over from before a resize

    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer.id());
    glGetTextureImage(
        texture.id(), 0, client_format(info, false), GL_UNSIGNED_BYTE, static_cast<GLsizei>(bytes),
        nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    pending_.push_back({std::move(buffer), Fence::insert(), width, height, info.channels});
}

std::optional<ByteImage> AsyncReadback::poll() {
    if (pending_.empty() || !pending_.front().fence.signaled()) {
        return std::nullopt;
    }
    Transfer transfer = std::move(pending_.front());
    pending_.pop_front();
    ByteImage image{transfer.width, transfer.height, transfer.channels, {}};
    image.pixels.resize(transfer.buffer.size());
    transfer.buffer.read(0, std::as_writable_bytes(std::span(image.pixels)));
    flip_rows(
        image.pixels,
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels),
        static_cast<std::size_t>(image.height));
    spare_.push_back(std::move(transfer.buffer));
    return image;
}

}  // namespace limn::gpu
