#include "systems/crowd/crowd_places.h"

#include "ecs/base/repeatable_math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {

CrowdBarrier place_obstacle(const CrowdObstacle& obstacle, const Affine& world) {
    CrowdBarrier barrier;
    barrier.center = {world.row[0].w, world.row[2].w};
    const Vec2 x = {world.row[0].x, world.row[2].x};
    const float scale = std::sqrt(glm::dot(x, x));
    if (scale > 0) {
        barrier.axis = x / scale;
    }
    if (obstacle.round) {
        barrier.radius = 0.5f * obstacle.size.x * scale;
    } else {
        const Vec2 z = {world.row[0].z, world.row[2].z};
        barrier.half = 0.5f * obstacle.size * Vec2(scale, std::sqrt(glm::dot(z, z)));
    }
    return barrier;
}

std::vector<CrowdBarrier>
place_obstacles(const Query<const CrowdObstacle>& obstacles, const Placements& placements) {
    std::vector<CrowdBarrier> barriers;
    obstacles.each([&](Entity entity, const CrowdObstacle& obstacle) {
        const CrowdBarrier barrier = place_obstacle(obstacle, placements.world(entity));
        if (is_finite(barrier.center) && is_finite(barrier.half) && is_finite(barrier.axis)
            && std::isfinite(barrier.radius)) {
            barriers.push_back(barrier);
        }
    });
    return barriers;
}

Quat turn_heading(const Quat& rotation, const Vec2& toward, float angle) {
    const Vec3 front = rotation * Vec3(0, 0, 1);
    const Vec3 from = normalize_or(Vec3(front.x, 0, front.z), Vec3(0, 0, 1));
    const Vec3 to = normalize_or(Vec3(toward.x, 0, toward.y), from);
    const float limit = std::min(angle, 1.2f);
    const Vec2 turn = repeatable_cos_sin(limit);
    Vec3 heading = to;
    if (glm::dot(from, to) < turn.x) {
        const float side = from.z * to.x - from.x * to.z >= 0 ? 1.0f : -1.0f;  // about +y
        heading = {
            turn.x * from.x + side * turn.y * from.z, 0, turn.x * from.z - side * turn.y * from.x};
    }
    // Half of the angle from +z about +y.
    const float cosine = std::sqrt(std::max(0.5f * (1 + heading.z), 0.0f));
    const float sine = std::sqrt(std::max(0.5f * (1 - heading.z), 0.0f));
    return {cosine, 0, heading.x < 0 ? -sine : sine, 0};
}

float stride_rate(float speed, float stride, float duration) {
    return std::min(speed * duration / stride, 100.0f);
}

}  // namespace limn
