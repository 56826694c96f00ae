#include "render/gpu/ring_buffer.h"
#include "tests/render/render_fixture.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

namespace limn::ring_buffer_test {
namespace {

using gpu::RingBuffer;
using gpu::RingSlice;

std::uint32_t read_back(const RingSlice& slice) {
    std::uint32_t value = 0;
    glGetNamedBufferSubData(
        slice.buffer, static_cast<GLintptr>(slice.offset), sizeof(value), &value);
    return value;
}

TEST_CASE_FIXTURE(test::RenderTest, "ring buffer: the GPU reads what the CPU writes") {
    RingBuffer ring(device().caps(), "ring", 4096);
    ring.begin_frame();
    const std::array<std::uint32_t, 3> numbers = {7, 8, 9};
    const RingSlice slice = ring.push(std::span<const std::uint32_t>(numbers));
    CHECK(slice.size == sizeof(numbers));
    CHECK(read_back(slice) == 7);
    ring.end_frame();
}

TEST_CASE_FIXTURE(
    test::RenderTest, "ring buffer: slices are aligned for bindings and never overlap") {
    RingBuffer ring(device().caps(), "ring", 1 << 16);
    ring.begin_frame();
    const auto alignment = static_cast<std::size_t>(
        std::max(device().caps().uniform_alignment, device().caps().storage_alignment));
    std::size_t end = 0;
    for (const std::size_t size : {1u, 100u, 0u, 256u, 1000u}) {
        const RingSlice slice = ring.allocate(size);
        CHECK(slice.offset % alignment == 0);
        CHECK(slice.offset >= end);
        end = slice.offset + size;
    }
    const RingSlice vertices = ring.allocate(36 * 10, 36);  // a vertex stride
    CHECK(vertices.offset % 36 == 0);
    CHECK(vertices.offset >= end);
    ring.end_frame();
}

TEST_CASE_FIXTURE(test::RenderTest, "ring buffer: many frames wrap around without growing") {
    RingBuffer ring(device().caps(), "ring", 16 * 1024);
    const GLuint buffer = [&] {
        ring.begin_frame();
        const RingSlice slice = ring.allocate(16);
        ring.end_frame();
        return slice.buffer;
    }();
    bool wrapped = false;
    std::size_t last = 0;
    for (std::uint32_t frame = 0; frame < 100; ++frame) {
        ring.begin_frame();
        std::array<RingSlice, 3> slices;
        for (std::uint32_t i = 0; i < slices.size(); ++i) {
            slices[i] = ring.allocate(1100);
            const std::uint32_t value = 1000 * frame + i;
            std::memcpy(slices[i].data, &value, sizeof(value));
            wrapped = wrapped || slices[i].offset < last;
            last = slices[i].offset;
        }
        for (std::uint32_t i = 0; i < slices.size(); ++i) {
            CHECK(read_back(slices[i]) == 1000 * frame + i);
            CHECK(slices[i].offset + slices[i].size <= ring.capacity());
        }
        CHECK(ring.used_in_frame() >= 3300);
        ring.end_frame();
        CHECK(slices[0].buffer == buffer);
    }
    CHECK(wrapped);
    CHECK(ring.growths() == 0);
}

TEST_CASE_FIXTURE(
    test::RenderTest, "ring buffer: a frame that needs more gets it at once and loses nothing") {
    RingBuffer ring(device().caps(), "ring", 1024);
    ring.begin_frame();
    std::vector<RingSlice> slices;
    for (std::uint32_t i = 0; i < 64; ++i) {
        slices.push_back(ring.push_value(i));
    }
    slices.push_back(ring.allocate(100'000));
    CHECK(ring.growths() > 0);
    CHECK(ring.capacity() >= 100'000);
    for (std::uint32_t i = 0; i < 64; ++i) {
        CHECK(read_back(slices[i]) == i);  // also those in the buffers it outgrew
    }
    ring.end_frame();
    const int growths = ring.growths();
    for (int frame = 0; frame < 10; ++frame) {
        ring.begin_frame();
        static_cast<void>(ring.allocate(30'000));
        ring.end_frame();
        glFinish();
    }
    CHECK(ring.growths() == growths);
}

TEST_CASE_FIXTURE(
    test::RenderTest, "ring buffer: outgrown buffers are deleted when their frame is done") {
    const auto buffers = gpu::live_objects(gpu::ObjectKind::Buffer);
    {
        RingBuffer ring(device().caps(), "ring", 256);
        ring.begin_frame();
        static_cast<void>(ring.allocate(10'000));
        CHECK(gpu::live_objects(gpu::ObjectKind::Buffer) == buffers + 2);
        ring.end_frame();
        glFinish();
        ring.begin_frame();
        CHECK(gpu::live_objects(gpu::ObjectKind::Buffer) == buffers + 1);
        ring.end_frame();
    }
    CHECK(gpu::live_objects(gpu::ObjectKind::Buffer) == buffers);
}

}  // namespace
}  // namespace limn::ring_buffer_test
