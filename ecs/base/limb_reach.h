#pragma once

#include "ecs/base/math.h"
#include "ecs/base/rotation.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {

// A chain of two bones, hip - knee - ankle or shoulder - elbow - wrist, brought to a target in
// closed form: the law of cosines gives the angle at the middle, a shortest arc aims the whole. The
// plane in which the chain bends stays.

/// The shortest rotation from unit `a` to unit `b`; about any perpendicular axis if opposite.
[[nodiscard]] inline Quat shortest_arc(const Vec3& a, const Vec3& b) {
    const float cosine = glm::dot(a, b);
    if (cosine > 1.0f - 1e-7f) {
        return {1, 0, 0, 0};
    }
    if (cosine < -1.0f + 1e-6f) {
        return rotation_about(any_perpendicular(a), kPi);
    }
    return glm::normalize(Quat(1.0f + cosine, glm::cross(a, b)));
}

/// Rotations in the space of the points: the middle turns by root * middle, the root by root.
struct TwoLinkTurns {
    Quat root = {1, 0, 0, 0};
    Quat middle = {1, 0, 0, 0};
};

/// Turns that bring the tip to `target`, or straight towards it if it is out of reach. `hinge`:
/// unit axis about which a positive angle bends a straight chain.
[[nodiscard]] inline TwoLinkTurns reach_with_two_links(
    const Vec3& root, const Vec3& middle, const Vec3& tip, const Vec3& target, const Vec3& hinge) {
    const Vec3 first = middle - root;
    const Vec3 second = tip - middle;
    const float a = glm::length(first);
    const float b = glm::length(second);
    if (!(a > 0) || !(b > 0)) {
        return {};
    }
    const float reach = std::clamp(glm::distance(root, target), std::abs(a - b), a + b);
    // Angle between the bones' directions, 0 when straight.
    const float wanted =
        std::acos(std::clamp((reach * reach - a * a - b * b) / (2 * a * b), -1.0f, 1.0f));
    const Vec3 cross = glm::cross(first, second);
    const float sine = glm::length(cross);
    const float current = std::atan2(sine, glm::dot(first, second));
    const bool is_straight = sine < 1e-3f * a * b;
    Vec3 axis = is_straight ? hinge : cross / sine;
    float turn = wanted - current;
    if (is_straight) {  // the hinge need not be exactly perpendicular
        axis = normalize_or(
            axis - glm::dot(axis, first) / (a * a) * first, any_perpendicular(first / a));
        turn = wanted;
    }
    TwoLinkTurns turns;
    turns.middle = rotation_about(axis, turn);
    const Vec3 bent = first + turns.middle * second;
    const Vec3 to_target = target - root;
    turns.root = shortest_arc(
        normalize_or(bent, first / a), normalize_or(to_target, normalize_or(bent, first / a)));
    return turns;
}

}  // namespace limn
