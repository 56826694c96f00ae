#include "systems/crowd/flock_rules.h"

#include "ecs/base/hash.h"
#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "systems/crowd/parting.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.flock

namespace limn {
namespace {

constexpr std::size_t kFlockGrain = 256;  // boids per task
constexpr float kNearest = 1e-3f;         // distances below count as this [m]

/// Sums over the neighbors of a boid.
struct FlockSums {
    Vec3 apart{0};
    Vec3 velocity{0};
    Vec3 offset{0};
    float count = 0;
};

void add_neighbor(
    const FlockParams& params, const FlockMember& boid, const FlockMember& other, float cosine,
    FlockSums& sums) {
    Vec3 offset = other.position - boid.position;
    if (params.planar) {
        offset.y = 0;
    }
    const float distance2 = glm::dot(offset, offset);
    const float distance = std::sqrt(distance2);
    if (distance > params.radius) {
        return;
    }
    // A coincident one has no direction: it is seen, and both part in a random one.
    const float speed = std::sqrt(glm::dot(boid.velocity, boid.velocity));
    if (glm::dot(offset, boid.velocity) < cosine * speed * distance) {
        return;
    }
    sums.velocity += other.velocity;
    sums.offset += offset;
    sums.count += 1;
    if (distance <= params.separation) {
        if (distance < kNearest) {
            const Vec2 away = parting_direction(boid.key, other.key);
            sums.apart += Vec3(away.x, 0, away.y) / kNearest;
        } else {
            sums.apart -= offset / distance2;
        }
    }
}

/// As if the nearest point of each obstacle were a neighbor.
Vec3 keep_off(
    const FlockParams& params, std::span<const CrowdBarrier> barriers, const Vec3& position) {
    Vec3 apart(0);
    for (const CrowdBarrier& barrier : barriers) {
        const BarrierHit hit = find_barrier(barrier, {position.x, position.z});
        if (hit.distance <= params.separation) {
            apart -= Vec3(hit.toward.x, 0, hit.toward.y) / std::max(hit.distance, 0.05f);
        }
    }
    return apart;
}

Vec3 wander_direction(const FlockParams& params, const Vec3& home, const FlockMember& boid) {
    Vec3 offset = home - boid.position;
    if (params.planar) {
        offset.y = 0;
    }
    const bool is_far = glm::dot(offset, offset) > square(params.home_radius);
    return is_far ? normalize_or(offset, boid.wander) : boid.wander;
}

}  // namespace

Vec3 allocate_acceleration(const FlockRules& rules, float budget) {
    Vec3 sum(0);
    for (const Vec3& rule : rules) {
        const float length = std::sqrt(glm::dot(rule, rule));
        if (length >= budget) {
            return length > 0 ? sum + rule * (budget / length) : sum;
        }
        sum += rule;
        budget -= length;
    }
    return sum;
}

void arrange_flock(
    const FlockParams& params, std::span<const FlockMember> boids, FlockScratch& scratch) {
    scratch.points.resize(boids.size());
    scratch.keys.resize(boids.size());
    for (std::size_t i = 0; i < boids.size(); ++i) {
        scratch.points[i] = {boids[i].position.x, boids[i].position.z};
        scratch.keys[i] = boids[i].key;
    }
    build_agent_grid(scratch.points, scratch.keys, params.radius, scratch.grid);
    scratch.slots.resize(boids.size());
    for (std::size_t i = 0; i < boids.size(); ++i) {
        scratch.slots[i] = boids[scratch.grid.order[i]];
    }
}

FlockRules find_flock_rules(
    const FlockParams& params, const Vec3& home, std::span<const CrowdBarrier> barriers,
    const FlockScratch& scratch, std::size_t slot) {
    const FlockMember& boid = scratch.slots[slot];
    const float cosine = params.view >= kPi ? -2.0f : std::cos(params.view);
    FlockSums sums;
    each_run(scratch.grid, {boid.position.x, boid.position.z}, params.radius, [&](SlotRun run) {
        for (std::uint32_t i = run.begin; i < run.end; ++i) {
            if (i != slot) {
                add_neighbor(params, boid, scratch.slots[i], cosine, sums);
            }
        }
    });
    FlockRules rules = {};
    rules[0] = params.avoid * (sums.apart + keep_off(params, barriers, boid.position));
    if (sums.count > 0) {
        rules[1] = params.match * (sums.velocity / sums.count - boid.velocity);
        rules[2] = params.center * (sums.offset / sums.count);
    }
    rules[3] = params.wander * wander_direction(params, home, boid);
    if (params.planar) {
        for (Vec3& rule : rules) {
            rule.y = 0;
        }
    }
    return rules;
}

void step_flock(
    const FlockParams& params, const Vec3& home, std::span<const CrowdBarrier> barriers, float dt,
    std::span<FlockMember> boids, FlockScratch& scratch) {
    arrange_flock(params, boids, scratch);
    scratch.accelerations.resize(boids.size());
    parallel_for(boids.size(), kFlockGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t slot = begin; slot < end; ++slot) {
            scratch.accelerations[slot] = allocate_acceleration(
                find_flock_rules(params, home, barriers, scratch, slot), params.max_acceleration);
        }
    });
    for (std::size_t slot = 0; slot < boids.size(); ++slot) {
        FlockMember& boid = boids[scratch.grid.order[slot]];
        Vec3 velocity = boid.velocity + dt * scratch.accelerations[slot];
        const float speed = std::sqrt(glm::dot(velocity, velocity));
        if (speed > params.max_speed) {
            velocity *= params.max_speed / speed;
        } else if (speed < params.min_speed) {
            velocity = params.min_speed * normalize_or(velocity, boid.wander);
        }
        boid.velocity = velocity;
        boid.position += dt * velocity;
    }
}

}  // namespace limn
