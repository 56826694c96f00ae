#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <utility>

namespace limn::bench {

/// Maximum number of runs of each; see repeats_for().
inline int max_repeats = 400;

/// Repeats after which the minimum is trustworthy, for something done to `count` particles.
[[nodiscard]] inline int repeats_for(std::size_t count) {
    const std::size_t wanted = 20'000'000 / std::max<std::size_t>(count, 1);
    return std::min(static_cast<int>(std::clamp<std::size_t>(wanted, 9, 400)), max_repeats);
}

inline constexpr auto kUnprepared = [] {};

/// Time of a call [s].
template <typename Run>
double time_of(Run&& run) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    run();
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Best times of two functions over `count` particles, alternating, each after its untimed
/// preparation [ns per particle]: so that other work on the machine disturbs both alike.
template <typename PrepareA, typename A, typename PrepareB, typename B>
std::pair<double, double>
race(std::size_t count, PrepareA prepare_a, A a, PrepareB prepare_b, B b) {
    std::pair<double, double> best = {INFINITY, INFINITY};
    const int repeats = repeats_for(count);
    for (int i = 0; i < repeats; ++i) {
        prepare_a();
        best.first = std::min(best.first, time_of(a));
        prepare_b();
        best.second = std::min(best.second, time_of(b));
    }
    const double per_particle = 1e9 / static_cast<double>(count);
    return {best.first * per_particle, best.second * per_particle};
}

/// The same for one function.
template <typename Prepare, typename Run>
double best_time(std::size_t count, Prepare prepare, Run run) {
    double best = INFINITY;
    const int repeats = repeats_for(count);
    for (int i = 0; i < repeats; ++i) {
        prepare();
        best = std::min(best, time_of(run));
    }
    return best * 1e9 / static_cast<double>(count);
}

}  // namespace limn::bench
