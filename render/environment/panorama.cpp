#include "render/environment/panorama.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

// Techniques: env.angular-map, env.panorama

namespace limn {
namespace {

/// Arbitrary at the poles.
float longitude(const Vec3& direction) {
    if (direction.x == 0 && direction.z == 0) {
        return 0.5f;
    }
    return std::atan2(direction.x, -direction.z) / (2 * kPi) + 0.5f;
}

}  // namespace

Vec2 equirectangular_uv(const Vec3& direction) {
    const float across = std::sqrt(square(direction.x) + square(direction.z));
    return {longitude(direction), std::atan2(direction.y, across) / kPi + 0.5f};
}

Vec2 cylindrical_uv(const Vec3& direction, float half_angle) {
    const float across = std::sqrt(square(direction.x) + square(direction.z));
    const float height = direction.y / std::max(across, 1e-20f);
    return {
        longitude(direction), std::clamp(0.5f + height / (2 * std::tan(half_angle)), 0.0f, 1.0f)};
}

Vec2 angular_uv(const Vec3& direction) {
    const float across = std::sqrt(square(direction.x) + square(direction.z));
    // Straight up is 0 / 0; straight down is any point of the rim.
    const float away = std::atan2(across, direction.y) / (2 * kPi * std::max(across, 1e-20f));
    return Vec2(0.5f) + away * Vec2(direction.x, direction.z);
}

Vec2 panorama_uv(PanoramaMapping mapping, const Vec3& direction, float half_angle) {
    switch (mapping) {
    case PanoramaMapping::Equirectangular:
        return equirectangular_uv(direction);
    case PanoramaMapping::Cylindrical:
        return cylindrical_uv(direction, half_angle);
    case PanoramaMapping::Angular:
        break;
    }
    return angular_uv(direction);
}

}  // namespace limn
