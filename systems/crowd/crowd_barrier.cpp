#include "systems/crowd/crowd_barrier.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cmath>

namespace limn {

BarrierHit find_barrier(const CrowdBarrier& barrier, const Vec2& point) {
    const Vec2 offset = point - barrier.center;
    const Vec2 local = {
        glm::dot(offset, barrier.axis), glm::dot(offset, Vec2(-barrier.axis.y, barrier.axis.x))};
    const Vec2 nearest = glm::clamp(local, -barrier.half, barrier.half);
    const Vec2 out = local - nearest;
    const float distance2 = glm::dot(out, out);
    Vec2 normal(1, 0);
    float distance = 0;
    if (distance2 > 1e-12f) {
        distance = std::sqrt(distance2);
        normal = out / distance;
    } else {  // inside: out by the nearest side
        const Vec2 depth = barrier.half - glm::abs(local);
        const bool first = depth.x < depth.y;
        normal = first ? Vec2(local.x < 0 ? -1 : 1, 0) : Vec2(0, local.y < 0 ? -1 : 1);
        distance = first ? -depth.x : -depth.y;
    }
    const Vec2 world = {
        normal.x * barrier.axis.x - normal.y * barrier.axis.y,
        normal.x * barrier.axis.y + normal.y * barrier.axis.x};
    return {distance - barrier.radius, -world};
}

}  // namespace limn
