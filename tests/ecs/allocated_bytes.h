#pragma once

#include <atomic>
#include <cstddef>

namespace limn::test {

/// What the program has asked operator new for, if one of its sources includes allocation_count.h.
inline std::atomic<std::size_t> allocated_bytes = 0;

/// Bytes asked for while `work` ran, by all threads, whether they were given back or not.
template <typename Work>
std::size_t bytes_allocated_by(const Work& work) {
    const std::size_t before = allocated_bytes.load(std::memory_order_relaxed);
    work();
    return allocated_bytes.load(std::memory_order_relaxed) - before;
}

}  // namespace limn::test
