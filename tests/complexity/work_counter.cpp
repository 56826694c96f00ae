#include "tests/complexity/work_counter.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

// Compiled without the calls that it counts.

namespace {

std::atomic<std::uint64_t> blocks = 0;
std::atomic<std::uint64_t> allocations = 0;
std::atomic<std::uint64_t> bytes = 0;

void* allocate(std::size_t size, std::size_t align) {
    allocations.fetch_add(1, std::memory_order_relaxed);
    bytes.fetch_add(size, std::memory_order_relaxed);
    void* const memory = align <= alignof(std::max_align_t)
                             ? std::malloc(size > 0 ? size : 1)
                             : std::aligned_alloc(align, (size + align - 1) / align * align);
    if (memory == nullptr) {
        throw std::bad_alloc();
    }
    return memory;
}

}  // namespace

extern "C" void __sanitizer_cov_trace_pc();
extern "C" void __sanitizer_cov_trace_pc() {
    blocks.fetch_add(1, std::memory_order_relaxed);
}

void* operator new(std::size_t size) {
    return allocate(size, 1);
}
void* operator new(std::size_t size, std::align_val_t align) {
    return allocate(size, static_cast<std::size_t>(align));
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    std::free(memory);
}

namespace limn::test {

Work work_so_far() {
    return {blocks.load(), allocations.load(), bytes.load()};
}

}  // namespace limn::test
