#include "systems/faces/wrinkle_ladder_system.h"

#include "ecs/base/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: skin.pipeline

namespace limn {
namespace {

float rung(float height, float from, float band) {
    return std::clamp((height - from) / std::max(band * from, 1e-3f), 0.0f, 1.0f);
}

/// Height of the bounds of a mesh, as if they faced the camera [px].
float height_on_screen(
    const Bounds& bounds, const Affine& world, const Vec3& eye, const Camera& camera, float rows) {
    const Vec3 center = transform_point(world, 0.5f * (bounds.min + bounds.max));
    const float scale = glm::length(Vec3(world.row[0].y, world.row[1].y, world.row[2].y));
    const float seen = camera.ortho_height > 0 ? camera.ortho_height
                                               : 2 * std::max(glm::distance(center, eye), 1e-6f)
                                                     * std::tan(0.5f * camera.fov_y);
    return finite_or((bounds.max.y - bounds.min.y) * scale / seen * rows, 0.0f);
}

}  // namespace

WrinkleRungs wrinkle_rungs(const WrinkleLadder& ladder, float height) {
    return {
        .displaced = rung(height, ladder.displaced_from, ladder.band),
        .strain = rung(height, ladder.strain_from, ladder.band),
        .maps = rung(height, ladder.maps_from, ladder.band)};
}

void add_wrinkle_rungs(Query<const WrinkleLadder, Without<WrinkleRungs>> faces, Commands commands) {
    faces.each([&](Entity entity, const WrinkleLadder&) { commands.add(entity, WrinkleRungs{}); });
}

void climb_wrinkle_ladders(
    Query<const WrinkleLadder, const MeshInstance, const WorldTransform, WrinkleRungs> faces,
    Query<const Camera, const WorldTransform> cameras, Res<const Assets> assets,
    OptionalRes<const Rendering> rendering) {
    const Camera* active = nullptr;
    Vec3 eye(0);
    cameras.each([&](const Camera& camera, const WorldTransform& transform) {
        if (camera.active && active == nullptr) {
            active = &camera;
            const Affine& world = transform.world;
            eye = {world.row[0].w, world.row[1].w, world.row[2].w};
        }
    });
    const float rows = rendering ? rendering->level_rows : Rendering{}.level_rows;
    faces.each([&](const WrinkleLadder& ladder, const MeshInstance& instance,
                   const WorldTransform& transform, WrinkleRungs& rungs) {
        if (active == nullptr) {
            rungs = {};
            return;
        }
        const bool has_mesh = instance.mesh.index < assets->meshes.size();
        rungs = wrinkle_rungs(
            ladder,
            has_mesh ? height_on_screen(
                assets->meshes[instance.mesh.index].bounds, transform.world, eye, *active, rows)
                     : 0.0f);
    });
}

}  // namespace limn
