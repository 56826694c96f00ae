#include "systems/animation/ik/foot_ground_system.h"

#include "ecs/components/humanoid.h"
#include "systems/animation/ik/placements.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {
namespace {

constexpr std::uint16_t kNoFoot = 0xffff;

/// A ground in this step.
struct PlacedGround {
    Entity entity{};
    Affine world{};
    Affine local{};  ///< local_from_world
    const MeshBvh* mesh = nullptr;
    const HeightField* field = nullptr;
};

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

const PlacedGround* find_placed(const std::vector<PlacedGround>& grounds, Entity entity) {
    const auto found =
        std::find_if(grounds.begin(), grounds.end(), [entity](const PlacedGround& ground) {
            return ground.entity == entity;
        });
    return found == grounds.end() ? nullptr : &*found;
}

/// The highest ground between both ends of a segment that points down.
struct Landing {
    const PlacedGround* ground = nullptr;
    Vec3 point = {0, 0, 0};   ///< in the world
    Vec3 normal = {0, 1, 0};  ///< likewise
};
Landing find_landing(const std::vector<PlacedGround>& grounds, const Segment& segment) {
    Landing landing;
    for (const PlacedGround& ground : grounds) {
        const std::optional<GroundHit> hit = find_hit(ground, segment);
        if (!hit) {
            continue;
        }
        const Vec3 point = point_at_height(ground, segment, hit->height);
        const bool is_inside = point.y <= segment.from.y && point.y >= segment.to.y;
        if (is_inside && (landing.ground == nullptr || point.y > landing.point.y)) {
            // Normals go with the transposed inverse.
            const Affine& local = ground.local;
            Vec3 normal(0);
            for (int i = 0; i < 3; ++i) {
                normal[i] = local.row[0][i] * hit->normal.x + local.row[1][i] * hit->normal.y
                            + local.row[2][i] * hit->normal.z;
            }
            normal = normalize_or(normal, Vec3(0, 1, 0));
            landing = {&ground, point, normal.y < 0 ? -normal : normal};
        }
    }
    return landing;
}

void update_foot(
    const std::vector<PlacedGround>& grounds, const Affine& world, const Affine& local,
    const FootPlant& plant, const Vec3& foot, float step, std::size_t i, FootContacts& contacts) {
    const auto on_floor = [&](float height) {
        return transform_point(world, Vec3(foot.x, height, foot.z));
    };
    const Segment segment = {on_floor(plant.step), on_floor(-plant.step)};
    const Landing landing = find_landing(grounds, segment);
    const PlacedGround* const last = find_placed(grounds, contacts.grounds[i]);
    // Height of the contact as its ground has carried it.
    const float carried =
        last != nullptr ? transform_point(local, transform_point(last->world, contacts.points[i])).y
                        : contacts.lifts[i];
    const float wanted = landing.ground != nullptr ? transform_point(local, landing.point).y : 0.0f;
    const float share = plant.speed > 0 ? 1 - std::exp(-plant.speed * step) : 1.0f;
    const bool is_first = contacts.feet[i] == kNoFoot;
    const float lift = std::clamp(
        carried + (is_first ? 1.0f : share) * (wanted - carried), -plant.step, plant.step);
    const Vec3 normal = landing.ground != nullptr
                            ? normalize_or(transform_vector(local, landing.normal), {0, 1, 0})
                            : Vec3(0, 1, 0);
    contacts.lifts[i] = lift;
    contacts.normals[i] =
        normalize_or(glm::mix(contacts.normals[i], normal, is_first ? 1.0f : share), Vec3(0, 1, 0));
    contacts.grounds[i] = landing.ground != nullptr ? landing.ground->entity : Entity{};
    if (landing.ground != nullptr) {
        contacts.points[i] = transform_point(landing.ground->local, on_floor(lift));
    }
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

void add_foot_contacts(
    Query<const FootPlant, With<Skeleton>, Without<FootContacts>> bare, Commands commands) {
    bare.each([&](Entity entity, const FootPlant&) { commands.add(entity, FootContacts{}); });
}

void update_foot_contacts(
    Query<const Skeleton, const FootPlant, const Pose, FootContacts> characters,
    Query<const Walkable, Optional<const MeshInstance>, Optional<const HeightField>> grounds,
    Query<const Transform> transforms, Query<const Parent> parents, Res<const Assets> assets,
    Res<WalkableMeshes> meshes, OptionalRes<const FrameTime> time) {
    if (characters.empty()) {
        return;
    }
    const Placements placements(transforms, parents);
    std::vector<PlacedGround> placed;
    // All hierarchies first: pointers into the list are taken when it no longer grows.
    grounds.each([&](Entity, const Walkable&, const MeshInstance* instance, const HeightField*) {
        if (instance != nullptr && instance->mesh.index < assets->meshes.size()) {
            (void)find_walkable_mesh(*assets, instance->mesh, *meshes);
        }
    });
    grounds.each([&](Entity entity, const Walkable&, const MeshInstance* instance,
                     const HeightField* field) {
        PlacedGround ground = {entity, placements.world(entity), {}, nullptr, field};
        const bool has_mesh =
            field == nullptr && instance != nullptr && instance->mesh.index < assets->meshes.size();
        if (has_mesh) {
            ground.mesh = find_walkable_mesh(*assets, instance->mesh, *meshes);
        }
        if (find_inverse(ground.world, ground.local)) {
            placed.push_back(ground);
        }
    });
    const float step = time ? time->step : 0.0f;
    characters.each([&](Entity entity, const Skeleton& skeleton, const FootPlant& plant,
                        const Pose& pose, FootContacts& contacts) {
        const std::uint32_t index = skeleton.skeleton.index;
        const Affine world = placements.world(entity);
        Affine local;
        if (index >= assets->skeletons.size() || pose.joints.empty()
            || !find_inverse(world, local)) {
            return;
        }
        std::array<std::uint16_t, 2> feet = contacts.feet;
        if (feet[0] == kNoFoot) {
            const BodyJoints body = find_body_joints(assets->skeletons[index]);
            feet = {body[BodyPart::LeftFoot], body[BodyPart::RightFoot]};
        }
        for (std::size_t i = 0; i < 2; ++i) {
            if (feet[i] < pose.joints.size()) {
                const Vec3 foot = transform_point(pose.joints[feet[i]], Vec3(0));
                update_foot(placed, world, local, plant, foot, step, i, contacts);
            }
        }
        contacts.feet = feet;
    });
}

}  // namespace limn
