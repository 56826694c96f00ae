#include "systems/particles/particle_obstacles.h"

#include "systems/animation/mesh_source.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

// Techniques: particle.collision-loop, particle.heightfield-collision

namespace limn {
namespace {

/// An entity that is a collider, of shape Mesh.
struct MeshObstacle {
    Entity entity;
    const Affine* world = nullptr;
    MeshSource source;
};

bool are_equal(const Affine& a, const Affine& b) {
    return a.row[0] == b.row[0] && a.row[1] == b.row[1] && a.row[2] == b.row[2];
}

void follow_mesh(const MeshObstacle& one, ParticleObstacles& obstacles) {
    std::vector<ObstacleMesh>& meshes = obstacles.meshes;
    auto mesh = std::find_if(meshes.begin(), meshes.end(), [&](const ObstacleMesh& other) {
        return other.entity == one.entity;
    });
    const bool is_new = mesh == meshes.end() || !(mesh->mesh == one.source.mesh)
                        || mesh->version != one.source.data->version;
    if (mesh == meshes.end()) {
        mesh = meshes.insert(meshes.end(), ObstacleMesh{.entity = one.entity});
    }
    mesh->frame = obstacles.frame;
    const bool deforms = one.source.deformed != nullptr;
    if (is_new || deforms || mesh->deforms || !are_equal(mesh->world, *one.world)) {
        transform_vertices(one.source, *one.world, mesh->positions);
        if (is_new) {
            mesh->bvh = build_mesh_bvh(mesh->positions, one.source.data->indices);
        } else {
            refit_mesh_bvh(mesh->bvh, mesh->positions, one.source.data->indices);
        }
    }
    mesh->mesh = one.source.mesh;
    mesh->version = one.source.data->version;
    mesh->world = *one.world;
    mesh->deforms = deforms;
}

/// Unit axes of an entity in world space, and how long they are.
struct Axes {
    Vec3 unit[3];
    Vec3 length;
};
Axes obstacle_axes(const Affine& world) {
    Axes axes{};
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 unit(0);
        unit[axis] = 1;
        const Vec3 axis_in_world = transform_vector(world, unit);
        axes.length[axis] = glm::length(axis_in_world);
        axes.unit[axis] = normalize_or(axis_in_world, unit);
    }
    return axes;
}

BoxCollider make_box(const Axes& axes, const Vec3& center, const Vec3& size) {
    Affine pose{};
    for (int row = 0; row < 3; ++row) {
        pose.row[row] = {axes.unit[0][row], axes.unit[1][row], axes.unit[2][row], center[row]};
    }
    return {pose, size * axes.length};
}

/// False for a field that is rotated, scaled, or not transformed yet.
bool is_upright_obstacle(const Affine& world) {
    constexpr float kTolerance = 1e-4f;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            if (!(std::abs(world.row[row][column] - (row == column ? 1.0f : 0.0f)) < kTolerance)) {
                return false;
            }
        }
    }
    return true;
}

HeightCollider make_field(const HeightField& field, const Vec3& center) {
    const auto points = static_cast<int>(field.points);
    const Vec2 cell = field.size / static_cast<float>(points - 1);
    return {
        .origin = center - Vec3(0.5f * field.size.x, 0, 0.5f * field.size.y),
        .cell = cell,
        .width = points,
        .depth = points,
        .heights = field.height};
}

}  // namespace

std::optional<Collider>
find_solid_shape(const ParticleCollider& collider, const Affine& world, const HeightField* field) {
    const Vec3 center = transform_point(world, Vec3(0));
    const Axes axes = obstacle_axes(world);
    switch (collider.shape) {
    case ColliderShape::Plane:
        return PlaneCollider{axes.unit[1], glm::dot(axes.unit[1], center)};
    case ColliderShape::Sphere:
        return SphereCollider{center, collider.size.x * axes.length.x, collider.hollow};
    case ColliderShape::Box:
        return make_box(axes, center, collider.size);
    case ColliderShape::HeightField:
        if (field != nullptr && field->points >= 2 && is_upright_obstacle(world)) {
            return make_field(*field, center);
        }
        return std::nullopt;
    case ColliderShape::Mesh:
    case ColliderShape::Water:  // not solid: update_particles asks the water
        return std::nullopt;
    }
    return std::nullopt;
}

void find_particle_obstacles(
    Query<
        const ParticleCollider, const WorldTransform, Optional<const MeshInstance>,
        Optional<const Deformed>, Optional<const DeformerState>,
        Optional<const SurfaceBindingState>, Optional<const HeightField>>
        colliders,
    Query<const Pose> poses, Query<const MorphWeights> morphs, Res<const Assets> assets,
    Res<ParticleObstacles> obstacles) {
    thread_local std::vector<Collider> found;  // memory of both is reused
    thread_local std::vector<MeshObstacle> followed;
    found.clear();
    followed.clear();
    ++obstacles->frame;
    colliders.each([&](Entity entity, const ParticleCollider& collider,
                       const WorldTransform& transform, const MeshInstance* instance,
                       const Deformed* deformed, const DeformerState* deformers,
                       const SurfaceBindingState* binding, const HeightField* field) {
        if (collider.shape != ColliderShape::Mesh) {
            if (auto shape = find_solid_shape(collider, transform.world, field)) {
                found.push_back(*shape);
            }
        } else if (instance != nullptr) {
            const MeshSource source = find_mesh_source(
                instance->mesh, deformed, deformers, poses, morphs, *assets, binding);
            if (source.data != nullptr) {
                followed.push_back({entity, &transform.world, source});
            }
        }
    });
    for (const MeshObstacle& one : followed) {
        follow_mesh(one, *obstacles);
    }
    std::erase_if(obstacles->meshes, [&](const ObstacleMesh& mesh) {
        return mesh.frame != obstacles->frame;
    });
    for (const ObstacleMesh& mesh : obstacles->meshes) {
        found.emplace_back(MeshCollider{&mesh.bvh});
    }
    set_colliders(obstacles->solid, found);
}

}  // namespace limn
