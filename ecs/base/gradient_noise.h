#pragma once

#include "ecs/base/math.h"

#include <cmath>
#include <cstdint>
#include <type_traits>

namespace limn {

// Gradient noise on the integer lattice: a pure function of position and seed, identical on every
// machine (no libm beyond sqrt and floor) and, up to rounding, in render/shaders/lib/noise.glsl.
// Every lattice point has a unit gradient, chosen by an integer hash; the linear ramps are blended
// with 6t^5 - 15t^4 + 10t^3, so that the noise is twice differentiable. It is 0 at lattice points
// and has mean 0; divided by its maximum, half the root of the number of dimensions, it stays
// within -1 .. 1. After K. Perlin, "Improving Noise" (2002).
// Techniques: shade.noise, water.noise-surface

/// 32 well-mixed bits for a point of the integer lattice.
[[nodiscard]] inline std::uint32_t lattice_hash(int x, int y, std::uint32_t seed) {
    // Three rounds of multiply and xor-shift (the constants are those of MurmurHash3's finalizer).
    std::uint32_t h = seed * 0x9e3779b9u ^ static_cast<std::uint32_t>(x) * 0x85ebca6bu;
    h = (h ^ (h >> 15)) * 0xc2b2ae35u ^ static_cast<std::uint32_t>(y) * 0x27d4eb2fu;
    h = (h ^ (h >> 13)) * 0x85ebca6bu;
    h = (h ^ (h >> 16)) * 0xc2b2ae35u;
    return h ^ (h >> 16);
}

/// The same hash as a number in [0, 1).
[[nodiscard]] inline float lattice_random(int x, int y, std::uint32_t seed) {
    return static_cast<float>(lattice_hash(x, y, seed) >> 8) * 0x1p-24f;
}

/// Maps 0 .. 1 to 0 .. 1, flat at both ends; its derivative is 30 t^2 (t - 1)^2.
template <typename T>
[[nodiscard]] T quintic_fade(const T& t) {
    return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

[[nodiscard]] inline float gradient_noise(float x, std::uint32_t seed) {
    const float cell = std::floor(x);
    const float t = x - cell;
    const auto slope = [&](int i) {
        return 2.0f * lattice_random(static_cast<int>(cell) + i, 0, seed) - 1.0f;
    };
    const float low = slope(0) * t;
    return 2.0f * (low + quintic_fade(t) * (slope(1) * (t - 1.0f) - low));
}

/// The gradient at a lattice point of the plane.
[[nodiscard]] inline Vec2 lattice_gradient(int x, int y, std::uint32_t seed) {
    constexpr float kLong = 0.92387953f;
    constexpr float kShort = 0.38268343f;
    constexpr float kDiagonal = 0.70710678f;
    static constexpr Vec2 kDirections[16] = {
        {1, 0},
        {-1, 0},
        {0, 1},
        {0, -1},
        {kLong, kShort},
        {-kLong, kShort},
        {kLong, -kShort},
        {-kLong, -kShort},
        {kShort, kLong},
        {-kShort, kLong},
        {kShort, -kLong},
        {-kShort, -kLong},
        {kDiagonal, kDiagonal},
        {-kDiagonal, kDiagonal},
        {kDiagonal, -kDiagonal},
        {-kDiagonal, -kDiagonal}};
    return kDirections[lattice_hash(x, y, seed) >> 28];
}

/// The cell of the lattice around a point of the plane.
struct NoiseCell {
    Vec2 fraction;     ///< of the point, from the corner (0, 0)
    Vec2 gradient[4];  ///< at the corners (0, 0), (1, 0), (0, 1), (1, 1)
    float ramp[4];     ///< of each gradient, at the point
};

/// `period` > 0 makes the noise tile with that many lattice cells; 0 = not periodic.
[[nodiscard]] inline NoiseCell
noise_cell(const Vec2& p, std::uint32_t seed, const IVec2& period = {0, 0}) {
    const auto wrap = [](int x, int cells) {
        const int rest = cells > 0 ? x % cells : x;
        return cells > 0 && rest < 0 ? rest + cells : rest;
    };
    const Vec2 low = {std::floor(p.x), std::floor(p.y)};
    NoiseCell cell;
    cell.fraction = p - low;
    for (int corner = 0; corner < 4; ++corner) {
        const int dx = corner % 2;
        const int dy = corner / 2;
        cell.gradient[corner] = lattice_gradient(
            wrap(static_cast<int>(low.x) + dx, period.x),
            wrap(static_cast<int>(low.y) + dy, period.y), seed);
        cell.ramp[corner] = cell.gradient[corner].x * (cell.fraction.x - static_cast<float>(dx))
                            + cell.gradient[corner].y * (cell.fraction.y - static_cast<float>(dy));
    }
    return cell;
}

inline constexpr float kPlaneNoiseScale = 1.41421356f;

[[nodiscard]] inline float
gradient_noise(const Vec2& p, std::uint32_t seed, const IVec2& period = {0, 0}) {
    const NoiseCell cell = noise_cell(p, seed, period);
    const auto& ramp = cell.ramp;
    const Vec2 w = quintic_fade(cell.fraction);
    const float low = ramp[0] + w.x * (ramp[1] - ramp[0]);
    const float high = ramp[2] + w.x * (ramp[3] - ramp[2]);
    return kPlaneNoiseScale * (low + w.y * (high - low));
}

/// Value and gradient of the noise.
struct NoiseSample {
    float value;
    Vec2 slope;
};

[[nodiscard]] inline NoiseSample
gradient_noise_slope(const Vec2& p, std::uint32_t seed, const IVec2& period = {0, 0}) {
    const NoiseCell cell = noise_cell(p, seed, period);
    const auto& [t, gradient, ramp] = cell;
    const Vec2 w = quintic_fade(t);
    const Vec2 dw = 30.0f * t * t * (t - 1.0f) * (t - 1.0f);
    const float low = ramp[0] + w.x * (ramp[1] - ramp[0]);
    const float high = ramp[2] + w.x * (ramp[3] - ramp[2]);
    const Vec2 slope_low =
        gradient[0] + w.x * (gradient[1] - gradient[0]) + Vec2(dw.x * (ramp[1] - ramp[0]), 0);
    const Vec2 slope_high =
        gradient[2] + w.x * (gradient[3] - gradient[2]) + Vec2(dw.x * (ramp[3] - ramp[2]), 0);
    const float value = low + w.y * (high - low);
    const Vec2 slope = slope_low + w.y * (slope_high - slope_low) + Vec2(0, dw.y * (high - low));
    return {kPlaneNoiseScale * value, kPlaneNoiseScale * slope};
}

[[nodiscard]] inline float gradient_noise(const Vec3& p, std::uint32_t seed) {
    const Vec3 cell = {std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    const Vec3 t = p - cell;
    const Vec3 w = quintic_fade(t);
    // Gradients toward the midpoints of a cube's twelve edges, four of them listed twice.
    static constexpr Vec3 kDirections[16] = {{1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0},
                                             {1, 0, 1}, {-1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
                                             {0, 1, 1}, {0, -1, 1}, {0, 1, -1}, {0, -1, -1},
                                             {1, 1, 0}, {0, -1, 1}, {-1, 1, 0}, {0, -1, -1}};
    const auto ramp = [&](int dx, int dy, std::uint32_t plane, float z) {
        const std::uint32_t h =
            lattice_hash(static_cast<int>(cell.x) + dx, static_cast<int>(cell.y) + dy, plane) >> 28;
        const Vec3& gradient = kDirections[h];
        return gradient.x * (t.x - static_cast<float>(dx))
               + gradient.y * (t.y - static_cast<float>(dy)) + gradient.z * z;
    };
    const auto plane = [&](int dz) {
        const std::uint32_t h = lattice_hash(static_cast<int>(cell.z) + dz, 1, seed);
        const float z = t.z - static_cast<float>(dz);
        const float a = ramp(0, 0, h, z);
        const float b = ramp(0, 1, h, z);
        const float low = a + w.x * (ramp(1, 0, h, z) - a);
        const float high = b + w.x * (ramp(1, 1, h, z) - b);
        return low + w.y * (high - low);
    };
    const float front = plane(0);
    constexpr float kScale = 0.81649658f;  // sqrt(1/2) normalizes gradients, 2 / sqrt(3) the range
    return kScale * (front + w.z * (plane(1) - front));
}

/// Noise in 0 .. 1 (shade.noise) of one, two or three coordinates; octave i has frequency 2^i and
/// amplitude 2^-i. 0.5 where |coordinate| is too large for fractional bits, and for NaN.
template <typename Point>
[[nodiscard]] float noise(const Point& point, std::uint32_t seed = 0, int octaves = 1) {
    const auto has_fraction = [](const Point& p) {
        if constexpr (std::is_same_v<Point, float>) {
            return std::abs(p) < 0x1p23f;
        } else {
            for (int i = 0; i < Point::length(); ++i) {
                if (!(std::abs(p[i]) < 0x1p23f)) {
                    return false;
                }
            }
            return true;
        }
    };
    float sum = 0;
    float total = 0;
    float amplitude = 1;
    float frequency = 1;
    for (int i = 0; i < octaves; ++i) {
        const Point p = point * frequency;
        sum += has_fraction(p) ? amplitude * gradient_noise(p, seed + static_cast<std::uint32_t>(i))
                               : 0.0f;
        total += amplitude;
        amplitude *= 0.5f;
        frequency *= 2.0f;
    }
    return 0.5f + 0.5f * sum / total;
}

}  // namespace limn
