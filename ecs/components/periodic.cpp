#include "ecs/components/periodic.h"

#include "ecs/base/gradient_noise.h"
#include "ecs/base/math.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

// Techniques: engine.periodic

namespace limn {
namespace {

constexpr double kNoiseBlock = 1024;  // periods of which floats tell fractions well
constexpr int kNoiseOctaves = 3;

/// Gradient noise is 0 wherever x is a whole number, so that blocks of other seeds join smoothly.
float noise_wave(double x, float phase) {
    const double block = std::floor(x / kNoiseBlock);
    const auto number = static_cast<std::uint32_t>(std::fmod(std::abs(block), 4294967296.0));
    const std::uint32_t seed = std::bit_cast<std::uint32_t>(phase) ^ (number * 0x9e3779b9u);
    return 2.0f * noise(static_cast<float>(x - block * kNoiseBlock), seed, kNoiseOctaves) - 1.0f;
}

float wave_at(const PeriodicFunction& function, double time) {
    const auto turns = static_cast<double>(function.frequency) * time;
    const auto phase = static_cast<double>(function.phase);
    if (!std::isfinite(turns) || !std::isfinite(phase)) {
        return 0;
    }
    if (function.wave == Wave::Noise) {
        return noise_wave(turns, function.phase);
    }
    const double x = turns - std::floor(turns) + phase - std::floor(phase);
    const double at = x - std::floor(x);  // of the period
    switch (function.wave) {
    case Wave::Triangle:
        return static_cast<float>(1 - 4 * std::abs(at - std::floor(at + 0.25) - 0.25));
    case Wave::Square:
        return at < 0.5 ? 1.0f : -1.0f;
    case Wave::Sawtooth:
        return static_cast<float>(2 * at - 1);
    default:
        return static_cast<float>(std::sin(2 * std::numbers::pi * at));
    }
}

}  // namespace

float evaluate(const PeriodicFunction& function, double time) {
    const float value = function.base + function.amplitude * wave_at(function, time);
    return finite_or(value, finite_or(function.base, 0));
}

float evaluate_share(const PeriodicFunction& function, double time) {
    return std::clamp(evaluate(function, time), 0.0f, 1.0f);
}

}  // namespace limn
