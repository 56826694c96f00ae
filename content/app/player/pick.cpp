#include "content/app/player/pick.h"

#include "content/app/player/posed_mesh.h"
#include "ecs/base/triangle.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/geometry/culling.h"
#include "render/render_view.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace limn {
namespace {

/// Distance along the ray at which it enters the box, if it does. `direction` need not be unit.
std::optional<float> hit_box(const Vec3& origin, const Vec3& direction, const Bounds& box) {
    float enter = 0.0f;
    float leave = INFINITY;
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0f) {
            if (origin[axis] < box.min[axis] || origin[axis] > box.max[axis]) {
                return std::nullopt;
            }
            continue;
        }
        const float a = (box.min[axis] - origin[axis]) / direction[axis];
        const float b = (box.max[axis] - origin[axis]) / direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave ? std::optional(enter) : std::nullopt;
}

/// A mesh whose box the ray hits, in the mesh's space.
struct Candidate {
    Entity entity;
    const MeshData* mesh = nullptr;
    std::vector<Vec3> posed;  // deformed positions; empty if not deformed
    float inflate = 0.0f;
    Vec3 origin;
    Vec3 direction;  // scaled so that ray parameters are world distances
    float enter = 0.0f;
};

/// Box of the posed mesh, in its own space.
Bounds shape_bounds(const MeshData& mesh, const std::vector<Vec3>& posed) {
    Bounds box = posed.empty() ? mesh.bounds : Bounds{};
    for (const Vec3& p : posed) {
        grow(box, p);
    }
    return box;
}

std::optional<float> hit_mesh(const Candidate& candidate, float nearest) {
    const MeshData& mesh = *candidate.mesh;
    const auto corner = [&](std::size_t i) {
        const std::uint32_t vertex = mesh.indices[i];
        const bool moves = candidate.inflate != 0.0f && vertex < mesh.normals.size();
        const Vec3 outward = moves ? normalize_or(mesh.normals[vertex], {0, 0, 0}) : Vec3(0);
        const Vec3& position =
            candidate.posed.empty() ? mesh.positions[vertex] : candidate.posed[vertex];
        return position + candidate.inflate * outward;
    };
    std::optional<float> hit;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const auto found = hit_triangle(
            candidate.origin, candidate.direction, corner(i), corner(i + 1), corner(i + 2));
        if (found && found->distance < nearest) {
            nearest = found->distance;
            hit = nearest;
        }
    }
    return hit;
}

}  // namespace

Ray ray_through(const RenderView& view, const Vec2& point) {
    const Vec2 ndc = {2.0f * point.x - 1.0f, 1.0f - 2.0f * point.y};
    const Vec3 direction_vs = {ndc.x * view.tangent.x, ndc.y * view.tangent.y, -1.0f};
    return {
        .origin = transform_point(view.world_from_camera, {0, 0, 0}),
        .direction =
            normalize_or(transform_vector(view.world_from_camera, direction_vs), {0, 0, -1})};
}

std::optional<Hit> pick_entity(const World& world, const Ray& ray) {
    const Assets* assets = world.find_resource<Assets>();
    if (assets == nullptr) {
        return std::nullopt;
    }
    std::vector<Candidate> candidates;
    world.query<const WorldTransform, const MeshInstance, Optional<const Inflate>>().each(
        [&](Entity entity, const WorldTransform& transform, const MeshInstance& instance,
            const Inflate* inflate) {
            if (instance.mesh.index >= assets->meshes.size()) {
                return;
            }
            const MeshData& mesh = assets->meshes[instance.mesh.index];
            const Mat4 world_from_mesh = to_mat4(transform.world);
            if (is_empty(mesh.bounds) || glm::determinant(Mat3(world_from_mesh)) == 0.0f) {
                return;
            }
            const Affine mesh_from_world = to_affine(glm::inverse(world_from_mesh));
            Candidate candidate{
                .entity = entity,
                .mesh = &mesh,
                .posed = posed_positions(world, entity),
                .inflate = inflate != nullptr ? inflate->distance : 0.0f,
                .origin = transform_point(mesh_from_world, ray.origin),
                .direction = transform_vector(mesh_from_world, ray.direction)};
            if (const auto enter = hit_box(
                    candidate.origin, candidate.direction,
                    inflated(shape_bounds(mesh, candidate.posed), {candidate.inflate}))) {
                candidate.enter = *enter;
                candidates.push_back(std::move(candidate));
            }
        });
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.enter < b.enter;
    });
    std::optional<Hit> nearest;
    for (const Candidate& candidate : candidates) {
        if (nearest && candidate.enter >= nearest->distance) {
            break;  // the remaining boxes begin beyond the hit
        }
        const float limit = nearest ? nearest->distance : INFINITY;
        if (const std::optional<float> distance = hit_mesh(candidate, limit)) {
            nearest = Hit{candidate.entity, *distance};
        }
    }
    return nearest;
}

Bounds local_bounds(const World& world, Entity entity) {
    const Assets* assets = world.find_resource<Assets>();
    const MeshInstance* instance = world.find<MeshInstance>(entity);
    if (assets == nullptr || instance == nullptr || instance->mesh.index >= assets->meshes.size()) {
        return {};
    }
    const Inflate* inflate = world.find<Inflate>(entity);
    return inflated(
        shape_bounds(assets->meshes[instance->mesh.index], posed_positions(world, entity)),
        inflate != nullptr ? *inflate : Inflate{.distance = 0});
}

Bounds entity_bounds(const World& world, Entity entity) {
    const WorldTransform* transform = world.find<WorldTransform>(entity);
    const Bounds box = local_bounds(world, entity);
    return transform == nullptr || is_empty(box) ? Bounds{}
                                                 : transform_bounds(transform->world, box);
}

std::optional<Vec3> entity_center(const World& world, Entity entity) {
    const Bounds box = entity_bounds(world, entity);
    if (!is_empty(box)) {
        return center(box);
    }
    const WorldTransform* transform = world.find<WorldTransform>(entity);
    return transform != nullptr ? std::optional(transform_point(transform->world, {0, 0, 0}))
                                : std::nullopt;
}

}  // namespace limn
