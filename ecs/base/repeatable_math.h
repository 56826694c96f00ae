#pragma once

#include "ecs/base/math.h"

#include <bit>
#include <cstdint>

namespace limn {

// Functions made of additions, multiplications and operations on bits alone, which IEEE 754 and
// GLSL 4.50 round alike. Division, square roots and sines differ between processors and
// GPUs; an algorithm whose every step depends on the previous one, such as a furrow that ends where
// it meets another, then moves differently on each. The same functions in GLSL:
// render/shaders/lib/repeatable.glsl.
// Techniques: wrinkle.furrow.trace

/// 1 / x to a relative 3e-7, for |x| from 1e-30 to 1e30 (Newton's iteration).
[[nodiscard]] inline float repeatable_reciprocal(float x) {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
    const float size = std::bit_cast<float>(bits & 0x7fffffffu);
    float y = std::bit_cast<float>(0x7ef311c7u - (bits & 0x7fffffffu));
    for (int i = 0; i < 4; ++i) {
        y = y * (2.0f - size * y);
    }
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(y) | (bits & 0x80000000u));
}

/// 1 / sqrt(x) to a relative 3e-7, for x from 1e-30 to 1e30 (Newton's iteration).
[[nodiscard]] inline float repeatable_inverse_root(float x) {
    float y = std::bit_cast<float>(0x5f375a86u - (std::bit_cast<std::uint32_t>(x) >> 1));
    const float half = 0.5f * x;
    for (int i = 0; i < 4; ++i) {
        y = y * (1.5f - half * y * y);
    }
    return y;
}

/// The cosine and the sine of `angle`, |angle| <= 1.2 rad, to 1e-7 (Taylor's series).
[[nodiscard]] inline Vec2 repeatable_cos_sin(float angle) {
    constexpr float kCosine[] = {-1.0f / 3628800.0f, 1.0f / 40320.0f, -1.0f / 720.0f,
                                 1.0f / 24.0f,       -0.5f,           1.0f};
    constexpr float kSine[] = {-1.0f / 39916800.0f, 1.0f / 362880.0f, -1.0f / 5040.0f,
                               1.0f / 120.0f,       -1.0f / 6.0f,     1.0f};
    const float a2 = angle * angle;
    float cosine = 0;
    float sine = 0;
    for (int i = 0; i < 6; ++i) {
        cosine = cosine * a2 + kCosine[i];
        sine = sine * a2 + kSine[i];
    }
    return {cosine, sine * angle};
}

}  // namespace limn
