#include "systems/crowd/orca.h"

#include "ecs/base/check.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

// Techniques: char.flock

namespace limn {
namespace {

constexpr float kParallelSine = 1e-5f;  // of the angle between lines that count as parallel

using PlaneList = std::span<const VelocityPlane>;

bool is_met(const VelocityPlane& plane, const Vec2& v) {
    return glm::dot(plane.normal, v) >= plane.offset;
}

float excess_over(const VelocityPlane& plane, const Vec2& v) {
    return plane.offset - glm::dot(plane.normal, v);
}

/// What the optimum is: the velocity nearest to a point, or the one farthest in a direction.
struct VelocityAim {
    Vec2 target = {0, 0};
    bool is_direction = false;
};

/// The optimum on the border of planes[last], among the velocities that meet those before it.
bool solve_on_line(
    PlaneList planes, std::size_t last, float max_speed, const VelocityAim& aim, Vec2& result) {
    const VelocityPlane& line = planes[last];
    const float root2 = square(max_speed) - square(line.offset);
    if (root2 < 0) {
        return false;
    }
    const Vec2 base = line.offset * line.normal;
    const Vec2 direction = {line.normal.y, -line.normal.x};
    float high = std::sqrt(root2);
    float low = -high;
    for (std::size_t i = 0; i < last; ++i) {
        const float slope = glm::dot(planes[i].normal, direction);
        const float missing = excess_over(planes[i], base);
        if (std::abs(slope) <= kParallelSine) {
            if (missing > 0) {
                return false;
            }
            continue;
        }
        const float t = missing / slope;
        if (slope > 0) {
            low = std::max(low, t);
        } else {
            high = std::min(high, t);
        }
        if (low > high) {
            return false;
        }
    }
    const float along = glm::dot(direction, aim.target);
    const float best = aim.is_direction ? (along > 0 ? high : low) : std::clamp(along, low, high);
    result = base + best * direction;
    return true;
}

/// The optimum; planes.size(), or the first plane that no velocity meets with those before it:
/// `result` is then the optimum of those.
std::size_t solve_planes(PlaneList planes, float max_speed, const VelocityAim& aim, Vec2& result) {
    const float speed2 = glm::dot(aim.target, aim.target);
    result = aim.target;
    if (aim.is_direction || speed2 > square(max_speed)) {
        result *= max_speed / std::sqrt(speed2);
    }
    for (std::size_t i = 0; i < planes.size(); ++i) {
        if (!is_met(planes[i], result)) {
            const Vec2 previous = result;
            if (!solve_on_line(planes, i, max_speed, aim, result)) {
                result = previous;
                return i;
            }
        }
    }
    return planes.size();
}

/// The velocities that exceed `b` no more than `a`; false where their lines are nearly the same.
bool find_bisector(const VelocityPlane& a, const VelocityPlane& b, VelocityPlane& bisector) {
    const Vec2 normal = b.normal - a.normal;
    const float length2 = glm::dot(normal, normal);
    if (length2 <= square(kParallelSine)) {
        return false;
    }
    const float length = std::sqrt(length2);
    bisector = {normal / length, (b.offset - a.offset) / length};
    return true;
}

/// From the plane `failed` on: those after the hard ones are exceeded least.
void exceed_least(
    PlaneList planes, std::size_t hard, std::size_t failed, float max_speed, Vec2& result) {
    std::array<VelocityPlane, kMaxVelocityPlanes> projected;
    std::copy_n(planes.begin(), hard, projected.begin());
    float largest = 0;
    for (std::size_t i = failed; i < planes.size(); ++i) {
        const VelocityPlane& plane = planes[i];
        if (excess_over(plane, result) <= largest) {
            continue;
        }
        std::size_t count = hard;
        for (std::size_t j = hard; j < i; ++j) {
            count += find_bisector(plane, planes[j], projected[count]) ? 1 : 0;
        }
        const Vec2 previous = result;
        if (solve_planes({projected.data(), count}, max_speed, {plane.normal, true}, result)
            < count) {
            result = previous;  // by rounding only: the optimum so far is as good
        }
        largest = excess_over(plane, result);
    }
}

}  // namespace

VelocityPlane
avoid_walker(const WalkerDisc& walker, const WalkerDisc& other, const AvoidOptions& options) {
    const Vec2 offset = other.position - walker.position;
    const Vec2 relative = walker.velocity - other.velocity;
    const float distance2 = glm::dot(offset, offset);
    const float reach = walker.radius + other.radius;
    const bool overlaps = distance2 <= square(reach);
    const float rate = 1 / (overlaps ? options.contact_time : options.horizon);
    const Vec2 from_center = relative - rate * offset;  // of the cut-off disc
    const float along = glm::dot(from_center, offset);
    const float length2 = glm::dot(from_center, from_center);
    Vec2 normal;
    float change = 0;  // of the relative velocity, along the normal
    if (overlaps || (along < 0 && square(along) > square(reach) * length2)) {
        const float length = std::sqrt(length2);
        normal = length > kCenteredSpeed ? from_center / length : options.apart;
        change = rate * reach - length;
    } else {  // on a leg of the cone
        const float leg = std::sqrt(distance2 - square(reach));
        const float head_on = options.side * kHeadOnSpeed * reach * rate * leg;
        const float left = offset.x * relative.y - offset.y * relative.x;
        const float side = left + head_on > 0 ? 1.0f : -1.0f;
        normal =
            Vec2(
                -offset.x * reach - side * offset.y * leg, side * offset.x * leg - offset.y * reach)
            / distance2;
        change = -glm::dot(relative, normal);
    }
    return {normal, glm::dot(normal, walker.velocity) + options.share * change};
}

VelocityPlane avoid_wall(const Vec2& toward, float distance, float horizon) {
    return {-toward, -distance / horizon};
}

Vec2 solve_velocity(
    std::span<const VelocityPlane> planes, std::size_t hard, const Vec2& preferred,
    float max_speed) {
    LIMN_CHECK(planes.size() <= kMaxVelocityPlanes && hard <= planes.size());
    Vec2 result;
    const std::size_t failed = solve_planes(planes, max_speed, {preferred, false}, result);
    if (failed < planes.size()) {
        exceed_least(planes, hard, failed, max_speed, result);
    }
    return result;
}

}  // namespace limn
