#include "systems/crowd/crowd_floor.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cstddef>

// Techniques: char.flock

namespace limn {
namespace {

constexpr float kSteepest = 1.2f;     // rise over run
constexpr float kSettleSpeed = 0.3f;  // [m/s]

/// Where a ground may be, in the world.
Bounds ground_box(const PlacedGround& ground) {
    if (ground.mesh == nullptr) {
        return {Vec3(-INFINITY), Vec3(INFINITY)};
    }
    Bounds box;
    if (ground.mesh->nodes.empty()) {
        return box;
    }
    const MeshBvh::Node& root = ground.mesh->nodes[0];
    for (std::size_t i = 0; i < MeshBvh::kChildren; ++i) {
        if (root.child[i] == MeshBvh::kNoChild) {
            continue;
        }
        for (std::size_t corner = 0; corner < 8; ++corner) {
            const Vec3 local = {
                root.bounds[corner & 1][0][i], root.bounds[corner >> 1 & 1][1][i],
                root.bounds[corner >> 2][2][i]};
            const Vec3 world = transform_point(ground.world, local);
            box.min = glm::min(box.min, world);
            box.max = glm::max(box.max, world);
        }
    }
    constexpr float kRounding = 1e-3f;  // [m]
    return {box.min - kRounding, box.max + kRounding};
}

}  // namespace

CrowdFloor place_floor(const GroundQueries& queries) {
    CrowdFloor floor = {place_grounds(queries), {}};
    for (const PlacedGround& ground : floor.grounds) {
        floor.boxes.push_back(ground_box(ground));
    }
    return floor;
}

std::optional<float> find_floor(const CrowdFloor& floor, const Vec3& point, float climb) {
    if (!is_finite(point)) {
        return std::nullopt;
    }
    const Segment segment = {point + Vec3(0, climb, 0), point - Vec3(0, climb, 0)};
    std::optional<float> highest;
    for (std::size_t i = 0; i < floor.grounds.size(); ++i) {
        const Bounds& box = floor.boxes[i];
        const bool is_under = point.x >= box.min.x && point.x <= box.max.x && point.z >= box.min.z
                              && point.z <= box.max.z && segment.from.y >= box.min.y
                              && segment.to.y <= box.max.y;
        if (!is_under) {
            continue;
        }
        const Landing landing = find_landing({&floor.grounds[i], 1}, segment);
        if (landing.ground != nullptr) {
            highest = std::max(highest.value_or(landing.point.y), landing.point.y);
        }
    }
    return highest;
}

float follow_floor(float height, float floor, float speed, float dt) {
    const float most = (kSettleSpeed + kSteepest * speed) * dt;
    return height + std::clamp(floor - height, -most, most);
}

}  // namespace limn
