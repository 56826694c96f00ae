#include "systems/mesh_level_system.h"

#include <algorithm>
#include <cmath>

// Techniques: anim.bezier-patch-lod, engine.lod-mesh

namespace limn {
namespace {

Vec3 position_of(const WorldTransform& transform) {
    const Affine& world = transform.world;
    return {world.row[0].w, world.row[1].w, world.row[2].w};
}

/// Length of the image of `span` meters along the entity's x axis, in an image `rows` high [px].
float projected_span(
    const MeshLevels& levels, const Affine& world, float distance, const Camera& camera,
    float rows) {
    const float scale = glm::length(Vec3(world.row[0].x, world.row[1].x, world.row[2].x));
    const float height = camera.ortho_height > 0
                             ? camera.ortho_height
                             : 2.0f * std::max(distance, 1e-6f) * std::tan(0.5f * camera.fov_y);
    return levels.span * scale / height * rows;
}

}  // namespace

int choose_mesh_level(float projected_pixels, int count, int current, float pixels_per_quad) {
    LIMN_CHECK(count >= 1 && pixels_per_quad > 0);
    const auto level_for = [&](float pixels) {
        const float quads = std::clamp(pixels / pixels_per_quad, 1.0f, 1e9f);
        return std::min(static_cast<int>(std::floor(std::log2(quads))), count - 1);
    };
    const int wanted = level_for(projected_pixels);
    if (wanted > current) {
        return std::max(level_for(projected_pixels / 1.1f), current);
    }
    if (wanted < current) {
        return std::min(level_for(projected_pixels * 1.1f), current);
    }
    return wanted;
}

void choose_mesh_levels(
    Query<const MeshLevels, const WorldTransform, MeshInstance> entities,
    Query<const Camera, const WorldTransform> cameras, OptionalRes<const Rendering> rendering) {
    const Camera* active = nullptr;
    Vec3 eye(0);
    cameras.each([&](const Camera& camera, const WorldTransform& transform) {
        if (camera.active && active == nullptr) {
            active = &camera;
            eye = position_of(transform);
        }
    });
    if (active == nullptr) {
        return;
    }
    const float rows = rendering ? rendering->level_rows : Rendering{}.level_rows;
    entities.each(
        [&](const MeshLevels& levels, const WorldTransform& transform, MeshInstance& instance) {
            if (levels.meshes.empty()) {
                return;
            }
            const auto now = std::find(levels.meshes.begin(), levels.meshes.end(), instance.mesh);
            const int current =
                now != levels.meshes.end() ? static_cast<int>(now - levels.meshes.begin()) : 0;
            const float distance = glm::length(position_of(transform) - eye);
            const float pixels = projected_span(levels, transform.world, distance, *active, rows);
            const int level = choose_mesh_level(
                pixels, static_cast<int>(levels.meshes.size()), current, levels.pixels_per_quad);
            const bool is_hidden = !(instance.mesh.index < kNoAsset);
            const bool hides = pixels < levels.drawn_from * (is_hidden ? 1.1f : 1.0f);
            instance.mesh = hides ? MeshId{} : levels.meshes[static_cast<std::size_t>(level)];
        });
}

}  // namespace limn
