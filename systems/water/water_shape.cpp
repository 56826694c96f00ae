#include "systems/water/water_shape.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {

namespace {

/// Fraction of a ball's volume below a plane at a fraction of its height.
float cap_volume(float fraction) {
    return fraction * fraction * (3 - 2 * fraction);
}

float unit_volume(WallShape shape) {
    switch (shape) {
    case WallShape::Box:
        return 8;
    case WallShape::Cylinder:
        return 2 * kPi;
    case WallShape::Ball:
        return 4.0f / 3.0f * kPi;
    }
    return 0;
}

}  // namespace

WaterShape place_shape(
    WallShape shape, const Vec3& half, const Vec3& offset, const Affine& world,
    const WaterFrame& frame) {
    WaterShape placed;
    placed.shape = shape;
    placed.center = frame.local(transform_point(world, offset));
    for (int i = 0; i < 3; ++i) {
        const Vec3 axis(world.row[0][i], world.row[1][i], world.row[2][i]);
        placed.axes[i] = frame.direction_to_local(axis) * half[i];
    }
    for (int i = 0; i < 3; ++i) {
        const Vec3 along = glm::abs(Vec3(placed.axes[0][i], placed.axes[1][i], placed.axes[2][i]));
        switch (shape) {
        case WallShape::Box:
            placed.half_extent[i] = along.x + along.y + along.z;
            break;
        case WallShape::Cylinder:
            placed.half_extent[i] = std::sqrt(along.x * along.x + along.z * along.z) + along.y;
            break;
        case WallShape::Ball:
            placed.half_extent[i] = glm::length(along);
            break;
        }
    }
    placed.volume =
        unit_volume(shape)
        * std::abs(glm::dot(placed.axes[0], glm::cross(placed.axes[1], placed.axes[2])));
    return placed;
}

float volume_below(const WaterShape& shape, float height) {
    const float above_lowest = height - (shape.center.y - shape.half_extent.y);
    const float fraction =
        std::clamp(above_lowest / std::max(2 * shape.half_extent.y, 1e-6f), 0.0f, 1.0f);
    return shape.volume * (shape.shape == WallShape::Ball ? cap_volume(fraction) : fraction);
}

}  // namespace limn
