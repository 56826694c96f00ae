#include "systems/animation/ik/two_link.h"

#include <algorithm>
#include <cmath>

// Techniques: char.ik-two-link

namespace limn {

TwoLinkAngles solve_two_link(
    const Vec2& target, float first_length, float second_length, bool bends_back,
    float previous_first) {
    const float distance2 = target.x * target.x + target.y * target.y;
    if (!std::isfinite(distance2)) {
        return {previous_first, 0};
    }
    const float product = 2 * first_length * second_length;
    const float cosine =
        product > 1e-30f
            ? (distance2 - first_length * first_length - second_length * second_length) / product
            : 1.0f;
    float second = std::acos(std::clamp(cosine, -1.0f, 1.0f));
    second = bends_back ? -second : second;
    // The tip relative to the first link.
    const float along = first_length + second_length * std::cos(second);
    const float across = second_length * std::sin(second);
    const float sine = along * target.y - across * target.x;
    const float cosine_first = along * target.x + across * target.y;
    const float size2 = first_length * first_length + second_length * second_length;
    const bool is_folded = along * along + across * across <= 1e-12f * size2;
    if (distance2 <= 1e-12f * size2 || is_folded) {
        return {previous_first, second};
    }
    return {std::atan2(sine, cosine_first), second};
}

Vec2 two_link_tip(const TwoLinkAngles& angles, float first_length, float second_length) {
    const float both = angles.first + angles.second;
    return {
        first_length * std::cos(angles.first) + second_length * std::cos(both),
        first_length * std::sin(angles.first) + second_length * std::sin(both)};
}

std::array<Vec2, 2>
two_link_jacobian(const TwoLinkAngles& angles, float first_length, float second_length) {
    const float both = angles.first + angles.second;
    const Vec2 second = {-second_length * std::sin(both), second_length * std::cos(both)};
    const Vec2 first = {
        -first_length * std::sin(angles.first), first_length * std::cos(angles.first)};
    return {first + second, second};
}

float soft_reach(float distance, float reach, float softness) {
    const float soft = std::clamp(softness, 0.0f, reach);
    const float begin = reach - soft;
    if (!(distance > begin)) {
        return distance;
    }
    return soft > 0 ? begin + soft * (1 - std::exp(-(distance - begin) / soft)) : reach;
}

}  // namespace limn
