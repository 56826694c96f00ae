#pragma once

#include "render/gpu/gl_object.h"

#include <span>
#include <type_traits>

namespace limn::gpu {

// GPU memory that the CPU fills occasionally. For data that changes every frame use RingBuffer.

enum class BufferUse : std::uint8_t {
    Static,   ///< filled once, at creation
    Dynamic,  ///< write() may change it
    GpuOnly,  ///< written only by shaders and copies
};

class Buffer {
  public:
    Buffer() = default;
    /// `size` > 0 bytes, undefined unless `data` (at least `size` bytes) is given.
    Buffer(std::string_view label, std::size_t size, BufferUse use, const void* data = nullptr);
    /// A Static buffer that holds `items`; one unused byte if there are none.
    template <typename T>
    [[nodiscard]] static Buffer of(std::string_view label, std::span<const T> items) {
        static_assert(std::is_trivially_copyable_v<T>);
        return items.empty() ? Buffer(label, 1, BufferUse::GpuOnly)
                             : Buffer(label, items.size_bytes(), BufferUse::Static, items.data());
    }

    /// Replaces bytes from `offset` on, within bounds; Dynamic buffers only. The first write after
    /// clear() or copy_from() waits for the GPU: do not do this every frame.
    void write(std::size_t offset, std::span<const std::byte> bytes);
    template <typename T>
    void write(std::size_t offset, std::span<const T> items) {
        static_assert(std::is_trivially_copyable_v<T>);
        write(offset, std::as_bytes(items));
    }

    /// Sets its first `bytes`, all by default, to the 32-bit `word`, on the GPU. As in textures,
    /// const does not protect the contents.
    void clear(std::uint32_t word, std::size_t bytes) const;
    void clear(std::uint32_t word) const { clear(word, size_); }
    /// Copies `bytes` of another buffer, within bounds of both, on the GPU.
    void copy_from(
        const Buffer& source, std::size_t source_offset, std::size_t offset, std::size_t bytes);

    /// Reads bytes back, waiting for the GPU: for tests and tools.
    void read(std::size_t offset, std::span<std::byte> bytes) const;
    template <typename T>
    [[nodiscard]] T read_value(std::size_t offset) const {
        T value;
        read(offset, std::as_writable_bytes(std::span(&value, 1)));
        return value;
    }

    [[nodiscard]] GLuint id() const { return object_.id(); }
    [[nodiscard]] std::uint64_t serial() const { return object_.serial(); }
    [[nodiscard]] std::size_t size() const { return object_ ? size_ : 0; }  ///< [bytes]
    explicit operator bool() const { return static_cast<bool>(object_); }

  private:
    GlObject<ObjectKind::Buffer> object_;
    std::size_t size_ = 0;
    BufferUse use_ = BufferUse::Static;
    mutable bool filled_by_gpu_ = false;  ///< by clear() or copy_from(), since the last write()
};

}  // namespace limn::gpu
