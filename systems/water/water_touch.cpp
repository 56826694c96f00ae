#include "systems/water/water_touch.h"

#include "systems/water/water_shape.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace limn {

namespace {

constexpr float kTouchBulgeScale = 1.5f;  ///< of the bulge, relative to the body's half extents
constexpr float kUnitBall = 4.0f / 3.0f * kPi;
constexpr float kMinHalfExtent = 1e-4f;  ///< half extent of a part [m]

/// Volume enclosed by its triangles, if closed and facing outward [m^3].
double enclosed_volume(const MeshData& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        Vec3 corner[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.indices[i + k];
            corner[k] = vertex < mesh.positions.size() ? mesh.positions[vertex] : Vec3(0);
        }
        sum += static_cast<double>(glm::dot(corner[0], glm::cross(corner[1], corner[2]))) / 6;
    }
    return sum;
}

/// The joint with the largest weight at a vertex; -1: none.
int main_joint(const SkinWeights& weights, std::size_t vertex) {
    int joint = -1;
    float most = 0;
    for (std::uint32_t i = weights.first[vertex]; i < weights.first[vertex + 1]; ++i) {
        if (weights.weights[i] > most) {
            most = weights.weights[i];
            joint = weights.joints[i];
        }
    }
    return joint;
}

bool is_whole(const SkinWeights& weights, std::size_t vertices) {
    return weights.first.size() == vertices + 1
           && std::is_sorted(weights.first.begin(), weights.first.end())
           && weights.first.back() <= weights.joints.size()
           && weights.joints.size() == weights.weights.size();
}

}  // namespace

TouchParts make_touch_parts(const MeshData& mesh, const SkinData* skin) {
    std::map<int, Bounds> boxes;
    const bool skinned = skin != nullptr && is_whole(mesh.skin, mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const int joint = skinned ? main_joint(mesh.skin, v) : -1;
        const bool is_joint = joint >= 0 && static_cast<std::size_t>(joint) < skin->joints.size();
        grow(boxes[is_joint ? joint : -1], mesh.positions[v]);
    }
    TouchParts parts;
    double held = 0;
    for (const auto& [joint, box] : boxes) {
        const Vec3 half = glm::max(half_extent(box), Vec3(kMinHalfExtent));
        if (!std::isfinite(glm::dot(half + glm::abs(center(box)), Vec3(1)))) {
            continue;
        }
        parts.parts.push_back({joint, center(box), half});
        held += static_cast<double>(kUnitBall * half.x * half.y * half.z);
    }
    const double volume = enclosed_volume(mesh);
    // At most the volume of the boxes, which is 6 / pi times that of their ellipsoids.
    const bool closed = volume > 1e-3 * held && volume < 2 * held;
    parts.fill = closed ? static_cast<float>(volume / held) : 1.0f;
    return parts;
}

void add_touch_parts(
    Query<const WaterTouch, const MeshInstance, Optional<const Deformed>, Optional<TouchParts>>
        bodies,
    Res<const Assets> assets, Commands commands) {
    bodies.each([&](Entity entity, const WaterTouch& touch, const MeshInstance& instance,
                    const Deformed* deformed, TouchParts* parts) {
        if (touch.shape != TouchShape::Mesh || instance.mesh.index >= assets->meshes.size()) {
            return;
        }
        const bool skinned = deformed != nullptr && deformed->skin.index < assets->skins.size();
        const auto mesh = static_cast<std::int32_t>(instance.mesh.index);
        const auto skin = skinned ? static_cast<std::int32_t>(deformed->skin.index) : -1;
        if (parts != nullptr && parts->mesh == mesh && parts->skin == skin) {
            return;
        }
        TouchParts made = make_touch_parts(
            assets->meshes[instance.mesh.index],
            skinned ? &assets->skins[deformed->skin.index] : nullptr);
        made.mesh = mesh;
        made.skin = skin;
        if (parts != nullptr) {
            *parts = std::move(made);
        } else {
            commands.add(entity, std::move(made));
        }
    });
}

void add_touching_shapes(
    const WaterTouch& touch, const Affine& world, const TouchParts* parts, const SkinData* skin,
    const Pose* pose, std::vector<TouchingShape>& shapes) {
    switch (touch.shape) {
    case TouchShape::Ball:
        shapes.push_back({WallShape::Ball, Vec3(touch.half.x), touch.offset, world});
        break;
    case TouchShape::Box:
        shapes.push_back({WallShape::Box, touch.half, touch.offset, world});
        break;
    case TouchShape::Mesh:
        for (std::size_t i = 0; parts != nullptr && i < parts->parts.size(); ++i) {
            const TouchPart& part = parts->parts[i];
            Affine part_world = world;
            const auto joint = static_cast<std::size_t>(std::max(part.joint, 0));
            if (part.joint >= 0 && skin != nullptr && pose != nullptr && joint < skin->joints.size()
                && joint < skin->joint_from_mesh.size()
                && skin->joints[joint] < pose->joints.size()) {
                part_world =
                    world * pose->joints[skin->joints[joint]] * skin->joint_from_mesh[joint];
            }
            shapes.push_back({WallShape::Ball, part.half, part.center, part_world, parts->fill});
        }
        break;
    }
}

WaterBulge bulge_of(
    const TouchingShape& touching, const WaterSurface& surface, float level, const Vec2& extent) {
    const WaterFrame& frame = surface.frame;
    const WaterShape shape =
        place_shape(touching.shape, touching.half, touching.offset, touching.world, frame);
    WaterBulge bulge;
    bulge.center = {shape.center.x, shape.center.z};
    bulge.radius = kTouchBulgeScale * Vec2(shape.half_extent.x, shape.half_extent.z);
    // Also rejects positions that are not finite.
    const bool over = std::abs(bulge.center.x) <= 0.5f * extent.x
                      && std::abs(bulge.center.y) <= 0.5f * extent.y
                      && std::isfinite(shape.center.y);
    if (!over) {
        return bulge;
    }
    if (surface.ocean != nullptr || surface.waves != nullptr) {
        WaterSurface calm = surface;
        calm.min_wavelength = 2 * std::max(shape.half_extent.x, shape.half_extent.z);
        const Vec3 center = frame.world(shape.center);
        const WaterPoint top = sample_water(calm, {center.x, center.z});
        level += top.is_water ? top.position.y - frame.origin.y : 0.0f;
    }
    bulge.volume = touching.fill * volume_below(shape, level);
    return bulge;
}

}  // namespace limn
