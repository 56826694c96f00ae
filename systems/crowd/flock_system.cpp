#include "systems/crowd/flock_system.h"

#include "ecs/base/rng.h"
#include "systems/crowd/crowd_places.h"
#include "systems/crowd/flock_rules.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

// Techniques: char.flock

namespace limn {
namespace {

/// A boid of the world, and what update_flocks() writes.
struct PlacedBoid {
    Entity entity{};
    Boid* boid = nullptr;
    Transform* transform = nullptr;
    ClipPlayer* player = nullptr;
};

/// A step of a random walk of directions, by about a radian in wander_time.
Vec3 next_wander(const FlockParams& params, const Vec3& wander, float step, Random& random) {
    Vec3 way(0);
    for (int tries = 0; tries < 8 && !(glm::dot(way, way) > 0.01f && glm::dot(way, way) < 1);
         ++tries) {
        way.x = random.uniform(-1.0f, 1.0f);
        way.y = params.planar ? 0.0f : random.uniform(-1.0f, 1.0f);
        way.z = random.uniform(-1.0f, 1.0f);
    }
    Vec3 next = wander + std::sqrt(2 * step / params.wander_time) * way;
    if (params.planar) {
        next.y = 0;
    }
    return normalize_or(next, wander);
}

/// Upright, +z along the velocity.
Quat boid_heading(const Quat& rotation, const Vec3& velocity) {
    const Quat yaw = turn_heading(rotation, {velocity.x, velocity.z}, kPi);
    const float speed2 = glm::dot(velocity, velocity);
    if (!(speed2 > 0)) {
        return yaw;
    }
    const float slope = std::clamp(velocity.y / std::sqrt(speed2), -1.0f, 1.0f);  // sine
    const float cosine = std::sqrt(1 - square(slope));
    const float half = std::sqrt(0.5f * (1 + cosine));
    return yaw * Quat(half, -0.5f * slope / half, 0, 0);
}

bool is_sound_boid(const FlockMember& boid) {
    return is_finite(boid.position) && is_finite(boid.velocity) && is_finite(boid.wander);
}

bool is_sound_flock(const FlockParams& params) {
    return std::isfinite(
               params.radius + params.separation + params.view + params.avoid + params.match
               + params.center + params.wander + params.wander_time + params.max_acceleration
               + params.min_speed + params.max_speed + params.home_radius + params.stride)
           && params.radius > 0 && params.wander_time > 0;
}

void write_boid(
    const FlockParams& params, const Assets& assets, const FlockMember& member,
    PlacedBoid& placed) {
    placed.boid->velocity = member.velocity;
    placed.boid->wander = member.wander;
    placed.transform->position = member.position;
    placed.transform->rotation = boid_heading(placed.transform->rotation, member.velocity);
    ClipPlayer* const player = placed.player;
    if (player != nullptr && params.stride > 0 && player->clip.index < assets.clips.size()) {
        player->speed = stride_rate(
            std::sqrt(glm::dot(member.velocity, member.velocity)), params.stride,
            assets.clips[player->clip.index].duration);
    }
}

}  // namespace

void update_flocks(
    Query<Boid, Transform, Optional<ClipPlayer>, Without<Parent>> boids,
    Query<const FlockParams> flocks, Query<const CrowdObstacle> obstacles,
    Query<const Transform> transforms, Query<const Parent> parents, Res<const Assets> assets,
    Res<const RandomSeed> seed, Res<const FrameTime> time) {
    if (boids.empty() || flocks.empty()) {
        return;
    }
    const Placements placements(transforms, parents);
    const std::vector<CrowdBarrier> barriers = place_obstacles(obstacles, placements);
    std::vector<PlacedBoid> all;
    boids.each([&](Entity entity, Boid& boid, Transform& transform, ClipPlayer* player) {
        all.push_back({entity, &boid, &transform, player});
    });
    std::stable_sort(all.begin(), all.end(), [](const PlacedBoid& a, const PlacedBoid& b) {
        return a.boid->flock.bits() < b.boid->flock.bits();
    });
    std::vector<FlockMember> members;
    std::vector<PlacedBoid> placed;
    FlockScratch scratch;
    for (std::size_t first = 0, end = 0; first < all.size(); first = end) {
        const Entity flock = all[first].boid->flock;
        for (end = first; end < all.size() && all[end].boid->flock == flock; ++end) {
        }
        const FlockParams* const params = flocks.find<const FlockParams>(flock);
        if (params == nullptr || !is_sound_flock(*params)) {
            continue;
        }
        members.clear();
        placed.clear();
        for (std::size_t i = first; i < end; ++i) {
            const Vec3 ahead =
                normalize_or(all[i].transform->rotation * Vec3(0, 0, 1), Vec3(0, 0, 1));
            FlockMember member;
            member.position = all[i].transform->position;
            member.velocity = all[i].boid->velocity;
            if (member.velocity == Vec3(0)) {
                member.velocity = params->min_speed * ahead;
            }
            Random random(
                seed->seed, all[i].entity.bits(), name_hash("update_flocks"), time->frame);
            member.wander =
                next_wander(*params, normalize_or(all[i].boid->wander, ahead), time->step, random);
            member.key = all[i].entity.bits();
            if (is_sound_boid(member)) {
                members.push_back(member);
                placed.push_back(all[i]);
            }
        }
        const Affine world = placements.world(flock);
        const Vec3 home = {world.row[0].w, world.row[1].w, world.row[2].w};
        step_flock(*params, home, barriers, time->step, members, scratch);
        for (std::size_t i = 0; i < members.size(); ++i) {
            write_boid(*params, *assets, members[i], placed[i]);
        }
    }
}

}  // namespace limn
