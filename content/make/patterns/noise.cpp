#include "content/make/patterns/noise.h"

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

}  // namespace

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
            const Vec2 offset = Vec2(x0 + dx, y0 + dy) + 0.5f + jitter * (random - 0.5f) - p;
            points[count++] = offset;
            const float distance = glm::length(offset);
            if (distance < sample.nearest) {
                sample.second = sample.nearest;
                sample.nearest = distance;
                sample.cell = lattice_hash(x, y, seed ^ 0x2545f491u);
                nearest = offset;
            } else if (distance < sample.second) {
                sample.second = distance;
            }
        }
    }
    // The border with a neighbor is the perpendicular bisector of the two points.
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
