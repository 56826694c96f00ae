#pragma once

#include <cstdint>

// Work, counted instead of timed, so that it is the same on every machine and under every load. The
// compiler puts a call into each basic block of the ECS and of the tests of this program
// (-fsanitize-coverage=trace-pc); memory is counted where it is asked for.

namespace limn::test {

struct Work {
    std::uint64_t blocks = 0;       ///< basic blocks that ran
    std::uint64_t allocations = 0;  ///< calls of operator new
    std::uint64_t bytes = 0;        ///< they asked for

    Work operator-(const Work& other) const {
        return {blocks - other.blocks, allocations - other.allocations, bytes - other.bytes};
    }
};

/// Since the program started, by all threads.
[[nodiscard]] Work work_so_far();

template <typename F>
[[nodiscard]] Work work_of(F&& function) {
    const Work before = work_so_far();
    function();
    return work_so_far() - before;
}

}  // namespace limn::test
