#include "systems/characters/grounds.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

/// Where a vertical segment of the world first hits the ground, from above.
std::optional<GroundHit> find_hit(const PlacedGround& ground, const Segment& world) {
    const Segment local = {
        transform_point(ground.local, world.from), transform_point(ground.local, world.to)};
    if (ground.mesh != nullptr) {
        const MeshHit hit = first_hit(*ground.mesh, local);
        if (hit.triangle == kNoTriangle) {
            return std::nullopt;
        }
        return GroundHit{glm::mix(local.from, local.to, hit.fraction).y, hit.normal};
    }
    if (ground.field != nullptr) {
        return find_height(*ground.field, local.from.x, local.from.z);
    }
    const float way = local.from.y - local.to.y;
    const bool crosses = way > 0 && local.from.y >= 0 && local.to.y <= 0;
    return crosses ? std::optional(GroundHit{}) : std::nullopt;
}

/// The point of the segment at a height of the ground's space.
Vec3 point_at_height(const PlacedGround& ground, const Segment& world, float height) {
    const float from = transform_point(ground.local, world.from).y;
    const float to = transform_point(ground.local, world.to).y;
    const float u = from != to ? std::clamp((height - from) / (to - from), 0.0f, 1.0f) : 0.0f;
    return glm::mix(world.from, world.to, u);
}

/// Normals go with the transposed inverse.
Vec3 world_normal(const PlacedGround& ground, const Vec3& normal) {
    Vec3 turned(0);
    for (int i = 0; i < 3; ++i) {
        turned[i] = ground.local.row[0][i] * normal.x + ground.local.row[1][i] * normal.y
                    + ground.local.row[2][i] * normal.z;
    }
    turned = normalize_or(turned, Vec3(0, 1, 0));
    return turned.y < 0 ? -turned : turned;
}

Bounds bounds_of(const Capsule& capsule) {
    return {
        glm::min(capsule.low, capsule.high) - capsule.radius,
        glm::max(capsule.low, capsule.high) + capsule.radius};
}

/// The box of the corners of a box after a map.
Bounds mapped(const Affine& map, const Bounds& box) {
    const Vec3 at = transform_point(map, center(box));
    const Vec3 half = half_extent(box);
    Vec3 size(0);
    for (int i = 0; i < 3; ++i) {
        size[i] = glm::dot(glm::abs(Vec3(map.row[i])), half);
    }
    return {at - size, at + size};
}

}  // namespace

const MeshBvh* find_walkable_mesh(const Assets& assets, MeshId id, WalkableMeshes& meshes) {
    const MeshData& mesh = assets.meshes[id.index];
    const auto found = std::find_if(
        meshes.entries.begin(), meshes.entries.end(),
        [id](const WalkableMeshes::Entry& entry) { return entry.mesh == id; });
    const bool is_new = found == meshes.entries.end();
    WalkableMeshes::Entry& entry = is_new ? meshes.entries.emplace_back() : *found;
    if (is_new || entry.version != mesh.version) {
        entry = {id, mesh.version, build_mesh_bvh(mesh.positions, mesh.indices)};
    }
    return &entry.bvh;
}

std::optional<GroundHit> find_height(const HeightField& field, float x, float z) {
    const std::size_t points = field.points;
    if (points < 2 || field.height.size() < points * points || !(field.size.x > 0)
        || !(field.size.y > 0)) {
        return std::nullopt;
    }
    const auto last = static_cast<float>(field.points - 1);
    const float u = (x / field.size.x + 0.5f) * last;
    const float v = (z / field.size.y + 0.5f) * last;
    if (!(u >= 0 && u <= last && v >= 0 && v <= last)) {
        return std::nullopt;
    }
    const auto i = std::min(static_cast<std::size_t>(u), std::size_t{field.points} - 2);
    const auto j = std::min(static_cast<std::size_t>(v), std::size_t{field.points} - 2);
    const float fu = u - static_cast<float>(i);
    const float fv = v - static_cast<float>(j);
    const float* const row = field.height.data() + j * field.points + i;
    const float near = glm::mix(row[0], row[1], fu);
    const float far = glm::mix(row[field.points], row[field.points + 1], fu);
    const float along = last / field.size.x
                        * glm::mix(row[1] - row[0], row[field.points + 1] - row[field.points], fv);
    const float across = last / field.size.y * (far - near);
    return GroundHit{
        glm::mix(near, far, fv), normalize_or(Vec3(-along, 1, -across), Vec3(0, 1, 0))};
}

std::vector<PlacedGround> place_grounds(const GroundQueries& queries) {
    std::vector<PlacedGround> placed;
    if (!queries.assets || !queries.meshes) {
        return placed;
    }
    const Placements placements(queries.transforms, queries.parents);
    const Assets& assets = *queries.assets;
    WalkableMeshes& meshes = *queries.meshes;
    // All hierarchies first: pointers into the list are taken when it no longer grows.
    queries.grounds.each(
        [&](Entity, const Walkable&, const MeshInstance* instance, const HeightField*) {
            if (instance != nullptr && instance->mesh.index < assets.meshes.size()) {
                (void)find_walkable_mesh(assets, instance->mesh, meshes);
            }
        });
    queries.grounds.each([&](Entity entity, const Walkable&, const MeshInstance* instance,
                             const HeightField* field) {
        PlacedGround ground = {
            entity, placements.root(entity), placements.world(entity), {}, nullptr, field};
        const bool has_mesh =
            field == nullptr && instance != nullptr && instance->mesh.index < assets.meshes.size();
        if (has_mesh) {
            ground.mesh = find_walkable_mesh(assets, instance->mesh, meshes);
        }
        if (find_inverse(ground.world, ground.local)) {
            placed.push_back(ground);
        }
    });
    return placed;
}

const PlacedGround* find_placed(std::span<const PlacedGround> grounds, Entity entity) {
    const auto found =
        std::find_if(grounds.begin(), grounds.end(), [entity](const PlacedGround& ground) {
            return ground.entity == entity;
        });
    return found == grounds.end() ? nullptr : &*found;
}

Landing find_landing(std::span<const PlacedGround> grounds, const Segment& segment) {
    Landing landing;
    for (const PlacedGround& ground : grounds) {
        const std::optional<GroundHit> hit = find_hit(ground, segment);
        if (!hit) {
            continue;
        }
        const Vec3 point = point_at_height(ground, segment, hit->height);
        const bool is_inside = point.y <= segment.from.y && point.y >= segment.to.y;
        if (is_inside && (landing.ground == nullptr || point.y > landing.point.y)) {
            landing = {&ground, point, world_normal(ground, hit->normal)};
        }
    }
    return landing;
}

float find_free_fraction(std::span<const PlacedGround> grounds, const Segment& segment) {
    float free = 1;
    for (const PlacedGround& ground : grounds) {
        if (ground.mesh == nullptr) {
            continue;
        }
        const MeshHit hit = first_hit(
            *ground.mesh, {transform_point(ground.local, segment.from),
                           transform_point(ground.local, segment.to)});
        if (hit.triangle != kNoTriangle) {
            free = std::min(free, hit.fraction);
        }
    }
    return free;
}

Vec3 find_way_out(std::span<const PlacedGround> grounds, const Vec3& point, float reach) {
    for (const PlacedGround& ground : grounds) {
        if (ground.mesh == nullptr) {
            continue;
        }
        Vec3 shortest(0);
        float least = 2;
        bool is_inside = true;
        for (const Vec3& way : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
            const Segment local = {
                transform_point(ground.local, point),
                transform_point(ground.local, point + reach * way)};
            const MeshHit hit = first_hit(*ground.mesh, local);
            is_inside =
                hit.triangle != kNoTriangle && glm::dot(hit.normal, local.to - local.from) > 0;
            if (!is_inside) {
                break;
            }
            if (hit.fraction < least) {
                least = hit.fraction;
                shortest = hit.fraction * reach * way;
            }
        }
        if (is_inside) {
            return shortest;
        }
    }
    return Vec3(0);
}

std::optional<GroundContact>
find_deepest_contact(std::span<const PlacedGround> grounds, const Capsule& capsule) {
    std::optional<GroundContact> deepest;
    if (!is_finite(capsule.low) || !is_finite(capsule.high)) {
        return deepest;
    }
    const Bounds bounds = bounds_of(capsule);
    for (const PlacedGround& ground : grounds) {
        if (ground.mesh == nullptr) {
            continue;
        }
        visit_triangles(
            *ground.mesh, mapped(ground.local, bounds),
            [&](std::uint32_t, const Vec3& a, const Vec3& b, const Vec3& c) {
                const TriangleCorners corners = {
                    transform_point(ground.world, a), transform_point(ground.world, b),
                    transform_point(ground.world, c)};
                const std::optional<CapsuleContact> contact = touch_triangle(capsule, corners);
                if (contact && (!deepest || contact->depth > deepest->contact.depth)) {
                    deepest = GroundContact{*contact, ground.entity};
                }
            });
    }
    return deepest;
}

}  // namespace limn
