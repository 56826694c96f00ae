#pragma once

#include "tests/ecs/allocated_bytes.h"

#include <cstddef>
#include <cstdlib>
#include <new>

// Counts what the program asks operator new for. Replaces the operators, so one source file of a
// program may include it.

namespace limn::test {

inline void* count_allocation(std::size_t size, std::size_t align) {
    allocated_bytes.fetch_add(size, std::memory_order_relaxed);
    void* memory = align <= alignof(std::max_align_t)
                       ? std::malloc(size > 0 ? size : 1)
                       : std::aligned_alloc(align, (size + align - 1) / align * align);
    if (memory == nullptr) {
        std::abort();
    }
    return memory;
}

/// Apart, so that no compiler takes the pair of it and operator new for a mistake.
[[gnu::noinline]] inline void give_back(void* memory) {
    std::free(memory);
}

}  // namespace limn::test

void* operator new(std::size_t size) {
    return limn::test::count_allocation(size, 1);
}
void* operator new[](std::size_t size) {
    return limn::test::count_allocation(size, 1);
}
void* operator new(std::size_t size, std::align_val_t align) {
    return limn::test::count_allocation(size, static_cast<std::size_t>(align));
}
void* operator new[](std::size_t size, std::align_val_t align) {
    return limn::test::count_allocation(size, static_cast<std::size_t>(align));
}
// The sanitizers have their own of these, which would not fit the rest.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return limn::test::count_allocation(size, 1);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return limn::test::count_allocation(size, 1);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
    limn::test::give_back(memory);
}
void operator delete[](void* memory, const std::nothrow_t&) noexcept {
    limn::test::give_back(memory);
}
void operator delete(void* memory) noexcept {
    limn::test::give_back(memory);
}
void operator delete[](void* memory) noexcept {
    limn::test::give_back(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    limn::test::give_back(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    limn::test::give_back(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    limn::test::give_back(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
    limn::test::give_back(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    limn::test::give_back(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
    limn::test::give_back(memory);
}
