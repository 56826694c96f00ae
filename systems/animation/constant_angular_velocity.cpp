#include "systems/animation/constant_angular_velocity.h"

#include "ecs/base/rotation.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

// Techniques: anim.constant-angular-velocity

namespace limn {
namespace {

constexpr double kMinAngle = 1e-6;  // smaller angles count as 0 [rad]

/// Between two rotations, the shorter arc [rad].
double angle_between(const Quat& a, const Quat& b) {
    return 2.0
           * static_cast<double>(
               glm::length(log_rotation(glm::conjugate(a) * to_same_hemisphere(a, b))));
}

/// Angle of each interval as a fraction of the total; equal fractions if the total is 0.
std::vector<double> turn_fractions(std::span<const Quat> keys) {
    std::vector<double> fractions;
    for (std::size_t i = 1; i < keys.size(); ++i) {
        fractions.push_back(angle_between(keys[i - 1], keys[i]));
    }
    const double all = std::accumulate(fractions.begin(), fractions.end(), 0.0);
    for (double& fraction : fractions) {
        fraction = all > kMinAngle ? fraction / all : 1.0 / static_cast<double>(fractions.size());
    }
    return fractions;
}

}  // namespace

TimedRotations make_constant_speed(std::span<const Quat> keys, float duration) {
    TimedRotations turns;
    for (const Quat& key : keys) {
        if (turns.rotations.empty() || angle_between(turns.rotations.back(), key) > kMinAngle) {
            turns.rotations.push_back(key);
        }
    }
    align_rotations(turns.rotations);
    double gone = 0;
    for (const double fraction : turn_fractions(turns.rotations)) {
        turns.times.push_back(static_cast<float>(gone * static_cast<double>(duration)));
        gone += fraction;
    }
    if (!turns.rotations.empty()) {
        turns.times.push_back(turns.rotations.size() > 1 ? duration : 0.0f);
    }
    return turns;
}

std::vector<int> distribute_frames(std::span<const Quat> keys, int frames) {
    const std::vector<double> fractions = turn_fractions(keys);
    std::vector<int> counts;
    std::vector<std::size_t> order(fractions.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (const double fraction : fractions) {
        counts.push_back(static_cast<int>(fraction * frames));
    }
    const auto lost = [&](std::size_t i) { return fractions[i] * frames - counts[i]; };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return lost(a) > lost(b);
    });
    int left = frames - std::accumulate(counts.begin(), counts.end(), 0);
    for (std::size_t i = 0; i < order.size() && left > 0; ++i, --left) {
        ++counts[order[i]];
    }
    return counts;
}

}  // namespace limn
