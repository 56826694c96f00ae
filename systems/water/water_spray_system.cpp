#include "systems/water/water_spray_system.h"

#include "systems/water/water_spray_drops.h"

#include <cmath>
#include <vector>

// Techniques: water.crest-spray, water.impact-spray

namespace limn {

namespace {

constexpr float kSprayReach =
    3.0f;  ///< largest height of the surface above or below an obstacle [m]

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
    Query<const SprayObstacle, const WorldTransform, SprayDrops, Without<SpraySource>> obstacles,
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
    obstacles.each([&](Entity entity, const SprayObstacle& obstacle,
                       const WorldTransform& transform, SprayDrops& drops) {
        drops.drops.clear();
        Random random = random_of(entity);
        const Vec3 point = transform_point(transform.world, Vec3(0));
        const Vec3 normal =
            normalize_or(transform_vector(transform.world, obstacle.normal), Vec3(0, 1, 0));
        for (const WaterSurface& surface : surfaces) {
            if (std::abs(surface.frame.origin.y - point.y) < kSprayReach) {
                spray_impact(surface, obstacle, point, normal, time->step, random, drops.drops);
            }
        }
    });
}

}  // namespace limn
