#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <vector>

namespace limn::bench {

/// CPU time of this thread [s]: other programs do not disturb it as much as the time of a clock.
[[nodiscard]] inline double thread_seconds() {
    timespec now = {};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Time of a clock [s], for what runs on several threads.
[[nodiscard]] inline double wall_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

inline constexpr int kMinRepeats = 9;

/// Best time of each run [s], in turns, so that other work on the machine disturbs all alike. Runs
/// take at least some 20 microseconds, which is much longer than reading the time.
template <typename Seconds, typename... Runs>
[[nodiscard]] std::array<double, sizeof...(Runs)>
race(Seconds seconds, int repeats, Runs&&... runs) {
    std::array<double, sizeof...(Runs)> best;
    best.fill(INFINITY);
    for (int i = 0; i < std::max(repeats, kMinRepeats); ++i) {
        std::size_t next = 0;
        const auto measure = [&](auto&& run) {
            const double begin = seconds();
            run();
            const double time = seconds() - begin;
            best[next] = std::min(best[next], time);
            ++next;
        };
        (measure(runs), ...);
    }
    return best;
}

/// The same, where other work of a frame has evicted all data from the caches before each run.
template <typename Seconds, typename... Runs>
[[nodiscard]] std::array<double, sizeof...(Runs)>
race_from_memory(Seconds seconds, int repeats, Runs&&... runs) {
    std::vector<char> other(std::size_t{96} << 20);
    char next = 0;
    const auto evict = [&] {
        std::fill(other.begin(), other.end(), ++next);
        asm volatile("" : : "g"(other.data()) : "memory");
    };
    std::array<double, sizeof...(Runs)> best;
    best.fill(INFINITY);
    for (int i = 0; i < std::max(repeats, kMinRepeats); ++i) {
        std::size_t place = 0;
        const auto measure = [&](auto&& run) {
            evict();
            const double begin = seconds();
            run();
            best[place] = std::min(best[place], seconds() - begin);
            ++place;
        };
        (measure(runs), ...);
    }
    return best;
}

/// Keeps the compiler from leaving out what was written to `data`.
inline void keep(const void* data) {
    asm volatile("" : : "g"(data) : "memory");
}

}  // namespace limn::bench
