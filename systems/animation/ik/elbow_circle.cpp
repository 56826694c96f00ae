#include "systems/animation/ik/elbow_circle.h"

#include "ecs/base/rotation.h"
#include "systems/animation/ik/two_link.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.elbow-circle, char.ik-two-link

namespace limn {
namespace {

/// The part of `v` perpendicular to unit `n`, as a unit vector; `fallback` if there is none.
Vec3 perpendicular_part(const Vec3& v, const Vec3& n, const Vec3& fallback) {
    const Vec3 part = v - glm::dot(v, n) * n;
    return glm::dot(part, part) > 1e-8f * glm::dot(v, v) ? normalize_or(part, fallback) : fallback;
}

/// Where the middle of a limb is, beside the line from its root to its tip.
Vec3 bend_direction(const LimbPoints& limb, const Vec3& hinge) {
    const Vec3 line = normalize_or(limb.tip - limb.root, normalize_or(limb.middle - limb.root, {}));
    const Vec3 upper = limb.middle - limb.root;
    const Vec3 beside = upper - glm::dot(upper, line) * line;
    const bool is_bent = glm::dot(beside, beside) > 1e-6f * glm::dot(upper, upper);
    return is_bent ? beside : glm::cross(line, hinge);
}

/// Rotation that takes the perpendicular unit vectors x and y to the other two.
Quat rotation_of_frames(const Vec3& x, const Vec3& y, const Vec3& to_x, const Vec3& to_y) {
    const Mat3 from(x, y, glm::cross(x, y));
    const Mat3 to(to_x, to_y, glm::cross(to_x, to_y));
    return extract_rotation(to * glm::transpose(from)).value_or(Quat(1, 0, 0, 0));
}

}  // namespace

Quat rotation_between(const Vec3& from, const Vec3& to) {
    const Vec3 a = normalize_or(from, Vec3(0));
    const Vec3 b = normalize_or(to, Vec3(0));
    if (a == Vec3(0) || b == Vec3(0)) {
        return {1, 0, 0, 0};
    }
    const float cosine = glm::dot(a, b);
    if (cosine < -1 + 1e-6f) {
        return {0, any_perpendicular(a)};
    }
    return normalize_or_identity(Quat(1 + cosine, glm::cross(a, b)));
}

ElbowCircle make_elbow_circle(
    const Vec3& shoulder, const Vec3& wrist, float upper, float lower, const Vec3& pole) {
    ElbowCircle circle;
    const Vec3 line = wrist - shoulder;
    const float distance = glm::length(line);
    circle.normal = normalize_or(line, Vec3(0, 0, 1));
    circle.toward_pole = perpendicular_part(pole, circle.normal, any_perpendicular(circle.normal));
    circle.sideways = glm::cross(circle.normal, circle.toward_pole);
    // Distance of the center from the shoulder: the foot of the elbow on the line.
    const float along = distance > 1e-6f * (upper + lower)
                            ? (upper * upper - lower * lower + distance * distance) / (2 * distance)
                            : 0.0f;
    const float clamped = std::clamp(along, -upper, upper);
    circle.center = shoulder + clamped * circle.normal;
    circle.radius = std::sqrt(std::max(0.0f, upper * upper - clamped * clamped));
    return circle;
}

Vec3 elbow_at(const ElbowCircle& circle, float swivel) {
    return circle.center
           + circle.radius
                 * (std::cos(swivel) * circle.toward_pole + std::sin(swivel) * circle.sideways);
}

LimbPoints solve_limb(const LimbPoints& limb, const Vec3& target, const LimbOptions& options) {
    const float upper = glm::distance(limb.root, limb.middle);
    const float lower = glm::distance(limb.middle, limb.tip);
    if (!is_finite(target) || !(upper + lower > 0)) {
        return limb;
    }
    const Vec3 now = limb.tip - limb.root;
    const Vec3 toward = normalize_or(target - limb.root, normalize_or(now, Vec3(0, 0, 1)));
    const float wanted = glm::distance(limb.root, target);
    const float distance =
        std::max(soft_reach(wanted, upper + lower, options.softness), std::abs(upper - lower));
    const Vec3 pole = is_finite(options.pole) && options.pole != Vec3(0)
                          ? options.pole
                          : rotation_between(now, toward) * bend_direction(limb, options.hinge);
    LimbPoints solved = {limb.root, {}, limb.root + distance * toward};
    const ElbowCircle circle = make_elbow_circle(limb.root, solved.tip, upper, lower, pole);
    solved.middle = elbow_at(circle, finite_or(options.swivel, 0.0f));
    // Exactly as long as it was, whatever was rounded.
    solved.middle = limb.root + upper * normalize_or(solved.middle - limb.root, circle.normal);
    solved.tip = solved.middle + lower * normalize_or(solved.tip - solved.middle, circle.normal);
    return solved;
}

LimbTurn find_limb_turn(const LimbPoints& from, const LimbPoints& to, const Vec3& hinge) {
    const Vec3 from_upper = normalize_or(from.middle - from.root, Vec3(0));
    const Vec3 to_upper = normalize_or(to.middle - to.root, Vec3(0));
    const Vec3 from_lower = normalize_or(from.tip - from.middle, Vec3(0));
    const Vec3 to_lower = normalize_or(to.tip - to.middle, Vec3(0));
    if (from_upper == Vec3(0) || to_upper == Vec3(0)) {
        const Quat lower = rotation_between(from_lower, to_lower);
        return {Quat(1, 0, 0, 0), lower};
    }
    const Vec3 bend = perpendicular_part(hinge, from_upper, any_perpendicular(from_upper));
    const Vec3 from_cross = glm::cross(from_upper, from_lower);
    const Vec3 to_cross = glm::cross(to_upper, to_lower);
    constexpr float kStraight = 1e-3f;  // sine of the bend below which its plane is noise
    Vec3 from_normal = glm::length(from_cross) > kStraight ? normalize_or(from_cross, bend) : bend;
    const Vec3 carried = rotation_between(from_upper, to_upper) * from_normal;
    const Vec3 to_normal =
        glm::length(to_cross) > kStraight ? normalize_or(to_cross, carried) : carried;
    const Quat upper = rotation_of_frames(from_upper, from_normal, to_upper, to_normal);
    // What the upper link's rotation does not do of the lower link's.
    const Quat lower = rotation_between(upper * from_lower, to_lower) * upper;
    return {upper, lower};
}

}  // namespace limn
