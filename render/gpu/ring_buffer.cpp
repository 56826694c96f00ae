#include "render/gpu/ring_buffer.h"

#include "ecs/base/check.h"
#include "render/gpu/device_caps.h"

#include <algorithm>
#include <numeric>

namespace limn::gpu {
namespace {

constexpr GLbitfield kMapFlags = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
constexpr std::uint64_t kOneSecond = 1'000'000'000;

std::uint64_t round_up(std::uint64_t value, std::uint64_t step) {
    return (value + step - 1) / step * step;
}

}  // namespace

RingBuffer::RingBuffer(const DeviceCaps& caps, std::string_view label, std::size_t bytes)
    : label_(label), alignment_(static_cast<std::size_t>(
                         std::max({caps.uniform_alignment, caps.storage_alignment, 64}))),
      capacity_(round_up(std::max<std::size_t>(bytes, 1), alignment_)),
      current_(map_new(capacity_)) {}

RingBuffer::~RingBuffer() = default;  // deleting a buffer unmaps it, after the GPU is done with it

RingBuffer::Mapped RingBuffer::map_new(std::size_t bytes) const {
    GLuint id = 0;
    glCreateBuffers(1, &id);
    Mapped mapped{GlObject<ObjectKind::Buffer>(id, label_)};
    glNamedBufferStorage(id, static_cast<GLsizeiptr>(bytes), nullptr, kMapFlags);
    mapped.object.set_bytes(bytes);
    mapped.data = static_cast<std::byte*>(
        glMapNamedBufferRange(id, 0, static_cast<GLsizeiptr>(bytes), kMapFlags));
    LIMN_CHECK_NOTE(mapped.data != nullptr, "out of memory for a mapped buffer");
    return mapped;
}

void RingBuffer::free_done_frames(int keep) {
    while (!in_flight_.empty()) {
        Frame& oldest = in_flight_.front();
        const bool must_wait = static_cast<int>(in_flight_.size()) > keep;
        if (!oldest.fence.signaled()) {
            if (!must_wait) {
                return;
            }
            while (!oldest.fence.wait(kOneSecond)) {
            }
        }
        tail_ = oldest.end;
        in_flight_.pop_front();
    }
}

void RingBuffer::begin_frame() {
    LIMN_CHECK(!in_frame_);
    in_frame_ = true;
    free_done_frames(kFramesInFlight - 1);
    frame_begin_ = head_;
}

void RingBuffer::end_frame() {
    LIMN_CHECK(in_frame_);
    in_frame_ = false;
    in_flight_.push_back({Fence::insert(), head_, std::move(retiring_)});
    retiring_.clear();
}

RingSlice RingBuffer::allocate(std::size_t size, std::size_t alignment) {
    LIMN_CHECK(in_frame_);
    const std::uint64_t step = alignment == 0 ? alignment_ : std::lcm(alignment, alignment_);
    const std::uint64_t needed = std::max<std::uint64_t>(size, 1);
    for (int attempt = 0;; ++attempt) {
        const std::uint64_t lap = head_ / capacity_ * capacity_;
        std::uint64_t offset = round_up(head_ - lap, step);
        std::uint64_t start = lap + offset;
        if (offset + needed > capacity_) {
            start = lap + capacity_;  // too little left at the end: wrap around
            offset = 0;
        }
        if (needed <= capacity_ && start + needed - tail_ <= capacity_) {
            head_ = start + needed;
            return {
                current_.data + offset, current_.object.id(), static_cast<std::size_t>(offset),
                size};
        }
        if (attempt == 0) {
            free_done_frames(
                kFramesInFlight);  // never waits: no more frames than that are in flight
        } else {
            grow(needed + step);
        }
    }
}

void RingBuffer::grow(std::size_t needed) {
    std::size_t larger = 2 * capacity_;
    while (larger < needed) {
        larger *= 2;
    }
    retiring_.push_back(std::move(current_));
    current_ = map_new(larger);
    capacity_ = larger;
    ++growths_;
    // The new buffer is empty: frames in flight used the old one and have nothing to free here.
    head_ = 0;
    tail_ = 0;
    frame_begin_ = 0;
    for (Frame& frame : in_flight_) {
        frame.end = 0;
    }
}

}  // namespace limn::gpu
