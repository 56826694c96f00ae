#pragma once

#include "ecs/base/hash.h"
#include "ecs/base/math.h"
#include "ecs/base/repeatable_math.h"

#include <algorithm>
#include <cstdint>

namespace limn {

/// A unit direction in which the first of two coincident walkers parts from the other: random by
/// their keys, and opposite for the other.
[[nodiscard]] inline Vec2 parting_direction(std::uint64_t own, std::uint64_t other) {
    const std::uint64_t hash = hash_combine(std::min(own, other), std::max(own, other));
    const float angle = static_cast<float>(hash >> 40) * 0x1p-24f * (0.5f * kPi) - 0.25f * kPi;
    const Vec2 direction = repeatable_cos_sin(angle);
    const bool turned = (hash & 1) != 0;
    const Vec2 way = turned ? Vec2(-direction.y, direction.x) : direction;
    return own < other ? way : -way;
}

}  // namespace limn
