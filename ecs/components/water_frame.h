#pragma once

#include "ecs/base/math.h"
#include "ecs/components/transform.h"

namespace limn {

/// Where a body of water lies: its own space has the rest surface at y = 0 and is turned about the
/// vertical alone.
struct WaterFrame {
    Vec3 origin = {0, 0, 0};  ///< [m]
    Vec2 along_x = {1, 0};    ///< the water's x axis as (x, z) of the world, unit

    /// (x, z) of the water's own space, height above rest between them.
    [[nodiscard]] Vec3 local(const Vec3& world) const { return turned_in(world - origin); }
    [[nodiscard]] Vec3 world(const Vec3& local) const { return origin + turned_out(local); }
    /// The same of directions.
    [[nodiscard]] Vec3 turned_in(const Vec3& v) const {
        return {along_x.x * v.x + along_x.y * v.z, v.y, along_x.x * v.z - along_x.y * v.x};
    }
    [[nodiscard]] Vec3 turned_out(const Vec3& v) const {
        return {along_x.x * v.x - along_x.y * v.z, v.y, along_x.y * v.x + along_x.x * v.z};
    }
};

/// Of a Water at this place. One that stands upright has no heading: 0.
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
