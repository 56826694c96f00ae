#pragma once

#include <cstdint>

// Shared by the scalar and the SIMD version of drawing births.
namespace limn::births {

// Taylor series with the error spread evenly over -pi/4 .. pi/4 (Moshier, Cephes).
inline constexpr float kSine[] = {-1.6666654611e-1f, 8.3321608736e-3f, -1.9515295891e-4f};
inline constexpr float kCosine[] = {
    4.166664568298827e-2f, -1.388731625493765e-3f, 2.443315711809948e-5f};
inline constexpr float kQuarterTurn = 1.57079632679f;

// The bits of a float approximate its logarithm: a third of them plus an offset is the first guess
// of Halley's iteration.
inline constexpr float kThird = 1.0f / 3;
inline constexpr std::int32_t kCubeRootBits = 0x2a514067;

// 1 / n!, n = 8 .. 2
inline constexpr float kExp[] = {1.0f / 40320, 1.0f / 5040, 1.0f / 720, 1.0f / 120,
                                 1.0f / 24,    1.0f / 6,    1.0f / 2};
inline constexpr int kExpTerms = 7;

inline constexpr float kMinLength2 = 1e-30f;  // of normalize_or

}  // namespace limn::births
