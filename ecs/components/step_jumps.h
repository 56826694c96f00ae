#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace limn {

// Discontinuities within a simulation step: a clip that starts over, a key with step interpolation,
// a cut of a camera path, a position that an event sets. Frames between two steps are interpolated
// from the previous state to the current one, which would show such a jump as fast motion.
//
// After a jump, the previous state therefore equals the current one: there is no velocity, and
// frames show the new state. If the time of the jump within the step is known, the state before the
// jump is listed here, and frames up to that time show it.

/// Jump time of entities that do not jump.
inline constexpr float kNoJump = std::numeric_limits<float>::infinity();

/// A system has moved an entity discontinuously.
struct JumpRequest {
    Entity entity;
    float at = 0;  ///< fraction of the step, 0 .. 1
};

/// Frames show `before` until the time `at`, WorldTransform from then on.
struct TransformJump {
    Entity entity;
    float at = 0;   ///< fraction of the step, 0 .. 1
    Affine before;  ///< world_from_local one simulation step earlier
};

/// Resource: the jumps of entities in the last step; never saved. Systems request them before
/// update_transforms, which lists them with all descendants.
struct StepJumps {
    std::vector<JumpRequest> requests;
    std::vector<TransformJump> transforms;  ///< in ascending order of entities
};

/// A joint matrix or a morph weight: frames show `before` until the time `at`, the current value
/// from then on.
template <typename T>
struct ValueJump {
    std::uint16_t index = 0;
    float at = 0;  ///< fraction of the step, 0 .. 1
    T before{};    ///< one simulation step earlier
};

/// The jump of `entity` in the last step; null if it did not jump.
[[nodiscard]] const TransformJump* find_jump(const StepJumps* jumps, Entity entity);

/// The jump of value `index` in an ascending list; null if it did not jump.
template <typename T>
[[nodiscard]] const ValueJump<T>*
find_jump(const std::vector<ValueJump<T>>& jumps, std::size_t index) {
    const auto found = std::ranges::lower_bound(jumps, index, {}, &ValueJump<T>::index);
    return found != jumps.end() && found->index == index ? &*found : nullptr;
}

}  // namespace limn
