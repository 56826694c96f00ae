#include "content/make/noise.h"

#include <algorithm>
#include <cmath>

namespace limn {

namespace {

/// Floored remainder: 0 .. period - 1; without a period, x itself.
int wrap(int x, int period) {
    if (period <= 0) {
        return x;
    }
    const int rest = x % period;
    return rest < 0 ? rest + period : rest;
}

/// Unit vectors in 16 directions.
constexpr float kLong = 0.92387953f;
constexpr float kShort = 0.38268343f;
constexpr float kDiagonal = 0.70710678f;
constexpr Vec2 kDirections[16] = {
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

/// Gradient noise of unit vectors stays within sqrt(1/2); this makes it 1.
constexpr float kNoiseScale = 1.41421356f;

}  // namespace

std::uint32_t lattice_hash(int x, int y, std::uint32_t seed) {
    // Three rounds of multiply and xor-shift (the constants are those of MurmurHash3's finalizer).
    std::uint32_t h = seed * 0x9e3779b9u ^ static_cast<std::uint32_t>(x) * 0x85ebca6bu;
    h = (h ^ (h >> 15)) * 0xc2b2ae35u ^ static_cast<std::uint32_t>(y) * 0x27d4eb2fu;
    h = (h ^ (h >> 13)) * 0x85ebca6bu;
    h = (h ^ (h >> 16)) * 0xc2b2ae35u;
    return h ^ (h >> 16);
}

float lattice_random(int x, int y, std::uint32_t seed) {
    return static_cast<float>(lattice_hash(x, y, seed) >> 8) * 0x1p-24f;
}

NoiseSample gradient_noise_slope(const Vec2& p, std::uint32_t seed, const IVec2& period) {
    const float cell_x = std::floor(p.x);
    const float cell_y = std::floor(p.y);
    const int x0 = static_cast<int>(cell_x);
    const int y0 = static_cast<int>(cell_y);
    const float fx = p.x - cell_x;
    const float fy = p.y - cell_y;

    // The gradient and its linear ramp at the four corners.
    Vec2 gradient[4];
    float ramp[4];
    for (int corner = 0; corner < 4; ++corner) {
        const int dx = corner % 2;
        const int dy = corner / 2;
        const std::uint32_t h =
            lattice_hash(wrap(x0 + dx, period.x), wrap(y0 + dy, period.y), seed);
        gradient[corner] = kDirections[h >> 28];
        ramp[corner] = gradient[corner].x * (fx - static_cast<float>(dx))
                       + gradient[corner].y * (fy - static_cast<float>(dy));
    }

    // Blended with 6t^5 - 15t^4 + 10t^3; its derivative is 30 t^2 (t - 1)^2.
    const Vec2 t = {fx, fy};
    const Vec2 w = t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
    const Vec2 dw = 30.0f * t * t * (t - 1.0f) * (t - 1.0f);
    const float low = ramp[0] + w.x * (ramp[1] - ramp[0]);
    const float high = ramp[2] + w.x * (ramp[3] - ramp[2]);
    const Vec2 slope_low =
        gradient[0] + w.x * (gradient[1] - gradient[0]) + Vec2(dw.x * (ramp[1] - ramp[0]), 0);
    const Vec2 slope_high =
        gradient[2] + w.x * (gradient[3] - gradient[2]) + Vec2(dw.x * (ramp[3] - ramp[2]), 0);
    const float value = low + w.y * (high - low);
    const Vec2 slope = slope_low + w.y * (slope_high - slope_low) + Vec2(0, dw.y * (high - low));
    return {kNoiseScale * value, kNoiseScale * slope};
}

float gradient_noise(const Vec2& p, std::uint32_t seed, const IVec2& period) {
    return gradient_noise_slope(p, seed, period).value;
}

float fractal_noise(
    const Vec2& p, std::uint32_t seed, const Octaves& octaves, const IVec2& period) {
    float sum = 0;
    float total = 0;
    float amplitude = 1;
    float frequency = 1;
    for (int i = 0; i < octaves.count; ++i) {
        sum += amplitude
               * gradient_noise(
                   p * frequency, seed + static_cast<std::uint32_t>(i), period * (1 << i));
        total += amplitude;
        amplitude *= octaves.gain;
        frequency *= 2.0f;
    }
    return sum / total;
}

float ridged_noise(const Vec2& p, std::uint32_t seed, const Octaves& octaves, const IVec2& period) {
    float sum = 0;
    float total = 0;
    float amplitude = 1;
    float frequency = 1;
    float weight = 1;
    for (int i = 0; i < octaves.count; ++i) {
        const float n =
            gradient_noise(p * frequency, seed + static_cast<std::uint32_t>(i), period * (1 << i));
        const float crest = square(1.0f - std::abs(n));
        sum += amplitude * weight * crest;
        total += amplitude;
        weight = std::clamp(1.5f * crest * weight, 0.0f, 1.0f);
        amplitude *= octaves.gain;
        frequency *= 2.0f;
    }
    return sum / total;
}

CellSample cell_noise(const Vec2& p, std::uint32_t seed, float jitter, const IVec2& period) {
    const Vec2 cell = glm::floor(p);
    const int x0 = static_cast<int>(cell.x);
    const int y0 = static_cast<int>(cell.y);

    CellSample sample = {1e9f, 1e9f, 1e9f, 0};
    Vec2 nearest = {0, 0};
    Vec2 points[25];
    int count = 0;
    for (int dy = -2; dy <= 2; ++dy) {
        for (int dx = -2; dx <= 2; ++dx) {
            const int x = wrap(x0 + dx, period.x);
            const int y = wrap(y0 + dy, period.y);
            const Vec2 random = {
                lattice_random(x, y, seed), lattice_random(x, y, seed ^ 0x68bc21ebu)};
            const Vec2 place = Vec2(x0 + dx, y0 + dy) + 0.5f + jitter * (random - 0.5f) - p;
            points[count++] = place;
            const float distance = glm::length(place);
            if (distance < sample.nearest) {
                sample.second = sample.nearest;
                sample.nearest = distance;
                sample.cell = lattice_hash(x, y, seed ^ 0x2545f491u);
                nearest = place;
            } else if (distance < sample.second) {
                sample.second = distance;
            }
        }
    }
    // The border with a neighbor is half way between the two points, at a right angle to their
    // line.
    for (int i = 0; i < count; ++i) {
        const Vec2 apart = points[i] - nearest;
        const float length2 = glm::dot(apart, apart);
        if (length2 > 1e-12f) {
            const float distance =
                glm::dot(0.5f * (points[i] + nearest), apart) / std::sqrt(length2);
            sample.edge = std::min(sample.edge, distance);
        }
    }
    return sample;
}

}  // namespace limn
