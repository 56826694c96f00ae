#include "systems/water/water_spray_system.h"

#include "systems/water/water_spray_drops.h"
#include "systems/water/water_touch.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

// Techniques: water.crest-spray, water.impact-spray

namespace limn {

namespace {

constexpr float kSprayReach =
    3.0f;  ///< largest height of the surface above or below an obstacle [m]

/// The surge of a surface where it was last measured.
struct MeasuredSurge {
    Vec2 around = {0, 0};  ///< in world space [m]
    float speed = -1;      ///< [m/s]; < 0: not measured yet
};
constexpr float kSurgeReach = 25.0f;  ///< within which it counts for other bodies [m]

float surge_at(const WaterSurface& surface, const Vec2& point, MeasuredSurge& last) {
    if (!(last.speed >= 0 && glm::distance(point, last.around) < kSurgeReach)) {
        last = {point, surge_speed(surface, point)};
    }
    return last.speed;
}

Affine centered_at(const Affine& world, const Vec3& offset) {
    return world * affine_from(offset, Quat(1, 0, 0, 0), Vec3(1));
}

/// The shapes that an obstacle has by what is beside it; empty: it is a point.
std::vector<SprayBody> find_spray_bodies(
    const Affine& now, const Affine& before, const WaterTouch* touch, const TouchParts* parts,
    const ParticleCollider* collider) {
    std::vector<SprayBody> bodies;
    if (touch != nullptr) {
        std::vector<TouchingShape> shapes;
        add_touching_shapes(*touch, Affine{}, parts, nullptr, nullptr, shapes);
        for (const TouchingShape& one : shapes) {
            bodies.push_back(
                {.is_box = one.shape == WallShape::Box,
                 .half = one.half,
                 .world = centered_at(now, one.offset),
                 .before = centered_at(before, one.offset)});
        }
    } else if (collider != nullptr && collider->shape == ColliderShape::Box) {
        bodies.push_back({true, collider->size, now, before});
    } else if (
        collider != nullptr && collider->shape == ColliderShape::Sphere && !collider->hollow) {
        bodies.push_back({false, Vec3(collider->size.x), now, before});
    }
    return bodies;
}

}  // namespace

void add_spray_drops(
    Query<const SpraySource, Without<SprayDrops>> sources,
    Query<const SprayObstacle, Without<SprayDrops>, Without<SpraySource>> obstacles,
    Commands commands) {
    sources.each([&](Entity entity, const SpraySource&) { commands.add(entity, SprayDrops{}); });
    obstacles.each(
        [&](Entity entity, const SprayObstacle&) { commands.add(entity, SprayDrops{}); });
}

void update_spray(
    WaterQuery waters, Query<const SpraySource, SprayDrops> sources,
    Query<
        const SprayObstacle, const WorldTransform, Optional<const PreviousWorldTransform>,
        Optional<const WaterTouch>, Optional<const TouchParts>, Optional<const ParticleCollider>,
        SprayDrops, Without<SpraySource>>
        obstacles,
    Res<const RandomSeed> seed, Res<const FrameTime> time) {
    const auto random_of = [&](Entity entity) {
        return Random(seed->seed, entity.bits(), name_hash("update_spray"), time->frame);
    };
    const std::vector<WaterSurface> surfaces = collect_water_surfaces(waters);
    for (const WaterSurface& surface : surfaces) {
        if (auto* const drops = sources.find<SprayDrops>(surface.entity)) {
            drops->drops.clear();
            Random random = random_of(surface.entity);
            const auto& source = *sources.find<const SpraySource>(surface.entity);
            spray_crests(surface, source, time->step, random, drops->drops);
            spray_breakers(surface, source, time->step, random, drops->drops);
        }
    }
    std::vector<MeasuredSurge> surges(surfaces.size());
    obstacles.each([&](Entity entity, const SprayObstacle& obstacle,
                       const WorldTransform& transform, const PreviousWorldTransform* previous,
                       const WaterTouch* touch, const TouchParts* parts,
                       const ParticleCollider* collider, SprayDrops& drops) {
        drops.drops.clear();
        Random random = random_of(entity);
        const Vec3 point = transform_point(transform.world, Vec3(0));
        const std::vector<SprayBody> bodies = find_spray_bodies(
            transform.world, previous != nullptr ? previous->world : transform.world, touch, parts,
            collider);
        SprayObstacle part = obstacle;
        part.rate /= static_cast<float>(std::max<std::size_t>(bodies.size(), 1));
        for (std::size_t i = 0; i < surfaces.size(); ++i) {
            const WaterSurface& surface = surfaces[i];
            const float crest_speed =
                bodies.empty() ? 0.0f : surge_at(surface, {point.x, point.z}, surges[i]);
            for (const SprayBody& body : bodies) {
                spray_body(surface, part, body, crest_speed, time->step, random, drops.drops);
            }
            if (bodies.empty() && std::abs(surface.frame.origin.y - point.y) < kSprayReach) {
                const Vec3 normal =
                    normalize_or(transform_vector(transform.world, obstacle.normal), Vec3(0, 1, 0));
                spray_impact(surface, obstacle, point, normal, time->step, random, drops.drops);
            }
        }
    });
}

}  // namespace limn
