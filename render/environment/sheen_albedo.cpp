#include "render/environment/sheen_albedo.h"

#include "ecs/base/jobs.h"
#include "ecs/base/math.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

// Techniques: shade.sheen

namespace limn {
namespace {

constexpr float kMinSheenRoughness = 0.07f;  // as in the shader

float sheen_masking_exponent(float cosine, float alpha) {
    const float t = square(1 - alpha);
    const float a = std::lerp(21.5473f, 25.3245f, t);
    const float b = std::lerp(3.82987f, 3.32435f, t);
    const float c = std::lerp(0.19823f, 0.16801f, t);
    const float d = std::lerp(-1.97760f, -1.27393f, t);
    const float e = std::lerp(-4.32054f, -4.85967f, t);
    return a / (1 + b * std::pow(cosine, c)) + d * cosine + e;
}

float sheen_masking(float cosine, float alpha) {
    return std::exp(
        cosine < 0.5f
            ? sheen_masking_exponent(cosine, alpha)
            : 2 * sheen_masking_exponent(0.5f, alpha) - sheen_masking_exponent(1 - cosine, alpha));
}

/// Sums over directions of light: the lobe is smooth but near n.l = 0, where steps are small.
float integrate_sheen(float n_v, float roughness) {
    constexpr int kRings = 32;
    constexpr int kSectors = 32;  // of half a turn: the lobe is symmetric
    const float sine_v = std::sqrt(1 - n_v * n_v);
    double sum = 0;
    for (int i = 0; i < kRings; ++i) {
        const float t = (static_cast<float>(i) + 0.5f) / kRings;
        const float n_l = t * t;  // d(n.l) = 2 t dt
        const float sine_l = std::sqrt(1 - n_l * n_l);
        for (int j = 0; j < kSectors; ++j) {
            const float phi = kPi * (static_cast<float>(j) + 0.5f) / kSectors;
            const float l_v = n_l * n_v + sine_l * sine_v * std::cos(phi);
            const float n_h = (n_l + n_v) / std::sqrt(std::max(2 + 2 * l_v, 1e-8f));
            sum += 2 * t * sheen_lobe(n_l, n_v, std::min(n_h, 1.0f), square(roughness));
        }
    }
    return static_cast<float>(sum * 2 * kPi / (kRings * kSectors));
}

}  // namespace

float sheen_lobe(float n_l, float n_v, float n_h, float alpha) {
    if (n_l <= 0) {
        return 0;
    }
    const float sine2 = std::max(1 - n_h * n_h, 1e-7f);
    const float distribution = (2 + 1 / alpha) * std::pow(sine2, 0.5f / alpha) / (2 * kPi);
    const float shadowing =
        1 + sheen_masking(n_v, alpha) + sheen_masking(std::max(n_l, 1e-4f), alpha);
    return distribution * std::min(1 / (4 * n_v * shadowing), n_l);
}

std::vector<float> make_sheen_albedo(int size) {
    std::vector<float> table(static_cast<std::size_t>(size) * size);
    parallel_for(size, 2, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            const float last = static_cast<float>(size - 1);
            const float roughness = std::max(static_cast<float>(y) / last, kMinSheenRoughness);
            for (int x = 0; x < size; ++x) {
                const float n_v = std::max(static_cast<float>(x) / last, 1e-3f);
                table[y * size + x] = integrate_sheen(n_v, roughness);
            }
        }
    });
    return table;
}

}  // namespace limn
