#pragma once

#include "ecs/base/math.h"
#include "ecs/components/transform.h"

namespace limn {

/// Local frame of a body of water: the rest surface is at y = 0, and the only rotation is about the
/// vertical axis.
struct WaterFrame {
    Vec3 origin = {0, 0, 0};  ///< [m]
    Vec2 along_x = {1, 0};    ///< the water's x axis as world (x, z), unit

    /// Position in the water's local space; y is the height above rest.
    [[nodiscard]] Vec3 local(const Vec3& world) const { return direction_to_local(world - origin); }
    [[nodiscard]] Vec3 world(const Vec3& local) const { return origin + direction_to_world(local); }
    /// The same for directions.
    [[nodiscard]] Vec3 direction_to_local(const Vec3& v) const {
        return {along_x.x * v.x + along_x.y * v.z, v.y, along_x.x * v.z - along_x.y * v.x};
    }
    [[nodiscard]] Vec3 direction_to_world(const Vec3& v) const {
        return {along_x.x * v.x - along_x.y * v.z, v.y, along_x.y * v.x + along_x.x * v.z};
    }
};

/// Frame of a Water with this world matrix. If its x axis is vertical, the heading is 0.
[[nodiscard]] inline WaterFrame water_frame(const Affine& world) {
    const Vec2 x(world.row[0].x, world.row[2].x);
    const float length = std::sqrt(x.x * x.x + x.y * x.y);
    WaterFrame frame;
    frame.origin = {world.row[0].w, world.row[1].w, world.row[2].w};
    if (length > 1e-6f) {
        frame.along_x = x / length;
    }
    return frame;
}

}  // namespace limn
