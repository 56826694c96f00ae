#include "systems/characters/view_bodies.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace limn {
namespace {

constexpr float kLargestLift = 0.75f;  // elevation up to which it rises over people [rad]
// Lateral distances from the line of sight [m]:
constexpr float kBesideFull = 0.25f;  // up to which a joint is looked over
constexpr float kBesideNone = 0.9f;   // at which it no longer occludes
constexpr float kReachOfBody = 4.0f;  // of joints from the root, at most [m]

/// 1 up to `full`, 0 from `none` on, with a continuous slope.
float fall_off(float x, float full, float none) {
    const float u = std::clamp((none - x) / (none - full), 0.0f, 1.0f);
    return u * u * (3.0f - 2.0f * u);
}

}  // namespace

std::vector<JointPlaces> find_bodies(
    const Query<const Pose, const WorldTransform>& characters, Entity except, const Vec3& point,
    float reach) {
    std::vector<JointPlaces> bodies;
    characters.each([&](Entity entity, const Pose& pose, const WorldTransform& placed) {
        const Vec3 root = transform_point(placed.world, Vec3(0));
        if (entity == except || !(glm::distance(root, point) <= reach + kReachOfBody)) {
            return;
        }
        JointPlaces joints;
        bool is_near = false;
        for (const Affine& joint : pose.joints) {
            joints.push_back(transform_point(placed.world, transform_point(joint, Vec3(0))));
            is_near = is_near || glm::distance(joints.back(), point) <= reach;
        }
        if (is_near) {
            bodies.push_back(std::move(joints));
        }
    });
    return bodies;
}

Vec3 look_over_bodies(
    std::span<const JointPlaces> bodies, const Vec3& point, const Vec3& wanted, float clearance) {
    const Vec3 way = wanted - point;
    const float distance = glm::length(way);
    const float level = std::hypot(way.x, way.z);
    if (!(level > 1e-3f) || !std::isfinite(distance)) {
        return wanted;
    }
    const Vec3 ahead = Vec3(way.x, 0, way.z) / level;
    const float elevation = std::atan2(way.y, level);
    float lift = 0;
    for (const JointPlaces& joints : bodies) {
        for (const Vec3& joint : joints) {
            const Vec3 to = joint - point;
            const float forward = glm::dot(to, ahead);
            const float beside = std::abs(to.x * ahead.z - to.z * ahead.x);
            const float nearest = std::max(forward, kBesideFull + clearance) - kBodyRadius;
            const float above = std::atan2(to.y + kBodyRadius + clearance, nearest);
            const float rise = std::min(above, kLargestLift) - elevation;
            // Those about `point` are beside it, and those behind the camera do not hide it.
            const float weight =
                fall_off(beside, kBesideFull, kBesideNone)
                * (1.0f - fall_off(forward, 0.5f * kBesideFull, kBesideFull + clearance))
                * fall_off(forward, distance, distance + kBesideNone);
            lift = std::max(lift, weight * rise);
        }
    }
    if (lift <= 0) {
        return wanted;
    }
    const float raised = elevation + lift;
    return point + distance * (std::cos(raised) * ahead + Vec3(0, std::sin(raised), 0));
}

Vec3 keep_off_bodies(
    std::span<const JointPlaces> bodies, const Vec3& point, const Vec3& camera, float clearance) {
    const Vec3 way = camera - point;
    const float distance = glm::length(way);
    if (!(distance > 0) || !std::isfinite(distance)) {
        return camera;
    }
    const Vec3 ahead = way / distance;
    const float radius = kBodyRadius + clearance;
    struct Stretch {
        float from;
        float to;
    };
    std::vector<Stretch> blocked;  // of the way, from `point` on
    for (const JointPlaces& joints : bodies) {
        for (const Vec3& joint : joints) {
            const Vec3 to = joint - point;
            const float middle = glm::dot(to, ahead);
            const float half = radius * radius - (glm::dot(to, to) - middle * middle);
            if (half > 0 && middle > 0 && glm::length(to) > radius) {
                blocked.push_back({middle - std::sqrt(half), middle + std::sqrt(half)});
            }
        }
    }
    float place = distance;
    for (bool moved = true; moved;) {
        moved = false;
        for (const Stretch& stretch : blocked) {
            if (stretch.from < place && place < stretch.to) {
                place = stretch.from;
                moved = true;
            }
        }
    }
    return place < distance ? point + place * ahead : camera;
}

}  // namespace limn
