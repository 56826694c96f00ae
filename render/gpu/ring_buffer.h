#pragma once

#include "render/gpu/buffer.h"
#include "render/gpu/fence.h"

#include <cstring>
#include <deque>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace limn::gpu {

struct DeviceCaps;

// Memory that the CPU writes and the GPU reads in the same frame: uniforms, instances, indirect
// draws. One persistently mapped buffer, used as a ring; one fence per frame tells when its range
// is free again. When a frame needs more than is free, a buffer of twice the size replaces it at
// once and the old one is deleted when the GPU is done with it, without a stall. At most
// kFramesInFlight frames are in flight; begin_frame() waits for the oldest beyond that, so that the
// CPU never runs far ahead.

/// Bytes for this frame. Write through `data` (write-combined memory: write in order, never read).
struct RingSlice {
    std::byte* data = nullptr;
    GLuint buffer = 0;
    std::size_t offset = 0;  ///< within the buffer [bytes]
    std::size_t size = 0;    ///< as requested [bytes]
};

class RingBuffer {
  public:
    static constexpr int kFramesInFlight = 3;

    /// `bytes`: initial capacity, shared by all frames in flight.
    RingBuffer(const DeviceCaps& caps, std::string_view label, std::size_t bytes);
    ~RingBuffer();
    RingBuffer(const RingBuffer&) = delete;
    RingBuffer& operator=(const RingBuffer&) = delete;

    /// Call these around everything in a frame that uses slices.
    void begin_frame();
    void end_frame();

    /// `size` bytes, aligned as bindings require and to a multiple of `alignment` (any number, such
    /// as the stride of a vertex). Valid until end_frame().
    [[nodiscard]] RingSlice allocate(std::size_t size, std::size_t alignment = 0);
    template <typename T>
    [[nodiscard]] RingSlice push(std::span<const T> items) {
        static_assert(std::is_trivially_copyable_v<T>);
        const RingSlice slice = allocate(items.size_bytes(), 0);
        if (!items.empty()) {
            std::memcpy(slice.data, items.data(), items.size_bytes());
        }
        return slice;
    }
    template <typename T>
    [[nodiscard]] RingSlice push_value(const T& value) {
        return push(std::span<const T>(&value, 1));
    }

    [[nodiscard]] std::size_t capacity() const { return capacity_; }                  ///< [bytes]
    [[nodiscard]] std::size_t used_in_frame() const { return head_ - frame_begin_; }  ///< [bytes]
    [[nodiscard]] int growths() const { return growths_; }  ///< times it had to grow

  private:
    struct Mapped {
        GlObject<ObjectKind::Buffer> object;
        std::byte* data = nullptr;
    };
    struct Frame {
        Fence fence;
        std::uint64_t end = 0;        // head_ at its end
        std::vector<Mapped> retired;  // buffers it outgrew
    };

    [[nodiscard]] Mapped map_new(std::size_t bytes) const;
    void free_done_frames(int keep);
    void grow(std::size_t needed);

    std::string label_;
    std::size_t alignment_ = 256;
    std::size_t capacity_ = 0;
    Mapped current_;
    // Positions only increase; the offset in the buffer is the position modulo capacity_.
    std::uint64_t head_ = 0;
    std::uint64_t tail_ = 0;  // everything before it is free
    std::uint64_t frame_begin_ = 0;
    std::deque<Frame> in_flight_;
    std::vector<Mapped> retiring_;  // outgrown in this frame
    bool in_frame_ = false;
    int growths_ = 0;
};

}  // namespace limn::gpu
