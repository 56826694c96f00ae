#include "content/make/models/implicit_model.h"

#include "content/make/models/loft.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {

namespace {

constexpr float kNothing = 1e3f;  ///< distance to a group without parts

/// Minimum, smoothed where the two are within `width` of each other (I. Quilez, "Smooth minimum").
float smooth_min(float a, float b, float width) {
    if (width <= 0.0f) {
        return std::min(a, b);
    }
    const float h = std::max(width - std::abs(a - b), 0.0f) / width;
    return std::min(a, b) - 0.25f * h * h * width;
}

float combine(float distance, const ModelPart& part, const Vec3& p) {
    const float own = part_distance(part, p);
    switch (part.use) {
    case PartUse::Join:
        return smooth_min(distance, own, part.blend);
    case PartUse::Cut:
        return -smooth_min(-distance, own, part.blend);
    case PartUse::Clip:
        return -smooth_min(-distance, -own, part.blend);
    }
    return distance;
}

/// A cone with rounded ends about the line from `a` to `b`.
float cone(const ModelPart& part, const Vec3& p) {
    const Vec3 axis = part.b - part.a;
    const float along = std::clamp(glm::dot(p - part.a, axis) / glm::dot(axis, axis), 0.0f, 1.0f);
    return glm::length(p - (part.a + along * axis)) - glm::mix(part.radius_a, part.radius_b, along);
}

float squashed_cone(const ModelPart& part, const Vec3& p) {
    const Vec3 q = (p - part.a) / part.squash;
    const Vec3 along = (part.b - part.a) / part.squash;
    const float t = glm::clamp(glm::dot(q, along) / glm::dot(along, along), 0.0f, 1.0f);
    const float radius = glm::mix(part.radius_a, part.radius_b, t);
    const float min_scale = std::min({part.squash.x, part.squash.y, part.squash.z});
    return (glm::length(q - t * along) - radius) * min_scale;
}

/// A lower bound of the distance (I. Quilez).
float ellipsoid(const ModelPart& part, const Vec3& p) {
    const Vec3 q = p - part.a;
    const float k0 = glm::length(q / part.b);
    const float k1 = glm::length(q / (part.b * part.b));
    const float min_radius = std::min({part.b.x, part.b.y, part.b.z});
    return k1 > 0.0f ? k0 * (k0 - 1.0f) / k1 : -min_radius;
}

float rounded_box(const ModelPart& part, const Vec3& p) {
    const Vec3 q = glm::abs(p - part.a) - part.b + part.radius_a;
    return glm::length(glm::max(q, Vec3(0))) + std::min(std::max({q.x, q.y, q.z}), 0.0f)
           - part.radius_a;
}

}  // namespace

float part_distance(const ModelPart& part, const Vec3& p) {
    switch (part.shape) {
    case PartShape::Cone:
        return cone(part, p);
    case PartShape::Squashed:
        return squashed_cone(part, p);
    case PartShape::Ellipsoid:
        return ellipsoid(part, p);
    case PartShape::Box:
        return rounded_box(part, p);
    case PartShape::Above:
        return part.a.y - p.y;
    case PartShape::Before:
        return part.a.z - p.z;
    case PartShape::Loft:
        return loft_distance(*part.loft, p);
    case PartShape::Custom:
        return part.distance(p);
    }
    return kNothing;
}

float group_distance(std::span<const ModelPart> parts, const Vec3& p, bool both_sides) {
    float distance = kNothing;
    for (const ModelPart& part : parts) {
        distance = combine(distance, part, p);
        if (both_sides && part.a.x > 0.0f) {
            distance = combine(distance, part, mirrored(p));
        }
    }
    return distance;
}

float model_distance(std::span<const ModelGroup> groups, const Vec3& p) {
    float distance = kNothing;
    for (const ModelGroup& group : groups) {
        distance = smooth_min(distance, group_distance(group.parts, p, false), group.blend);
    }
    return distance;
}

}  // namespace limn
