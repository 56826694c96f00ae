#include "systems/crowd/step_crowd.h"

#include "ecs/base/jobs.h"
#include "ecs/base/repeatable_math.h"
#include "ecs/base/rng.h"
#include "systems/crowd/parting.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

// Techniques: char.flock

namespace limn {
namespace {

constexpr std::size_t kCrowdGrain = 256;    // slots per task: whole batches
constexpr float kCellSize = 2.0f;           // [m]
constexpr float kContactTime = 0.2f;        // in which avoidance separates overlapping walkers [s]
constexpr float kWallHorizon = 0.4f;        // [s]
constexpr float kPersonalSpace = 0.02f;     // added to the sum of radii in avoidance [m]
constexpr float kPushSkin = 1e-3f;          // by which push-out separates [m]
constexpr float kOverlapTolerance = 5e-4f;  // overlap that remains [m]
constexpr int kMaxPushes = 4;
constexpr std::size_t kMaxWalls = 8;
constexpr float kEnoughProgress = 0.95f;  // share of its speed with which a walker is not blocked
constexpr float kDetourGrowth = 4;        // when fully blocked [rad/s]
constexpr float kDetourFading = 0.5f;     // when free [rad/s]
constexpr float kMinJitter = 0.002f;      // [m/s]
constexpr float kBlockedJitter = 0.1f;    // of the speed that is wanted
constexpr std::uint64_t kJitterFrames = 32;
constexpr float kSettling = 4;           // distance to the goal within which detours shrink [m]
constexpr float kStandingShare = 0.25f;  // priority of those that do not want to move

float standing_priority(const CrowdWalker& walker) {
    return walker.priority * (walker.wanted == Vec2(0) ? kStandingShare : 1.0f);
}

/// Where a walker would go without others: turned by its detour.
Vec2 preferred_velocity(const CrowdWalker& walker) {
    if (walker.detour == 0) {
        return walker.wanted;
    }
    const Vec2 turn = repeatable_cos_sin(walker.side * walker.detour);
    return {
        turn.x * walker.wanted.x - turn.y * walker.wanted.y,
        turn.y * walker.wanted.x + turn.x * walker.wanted.y};
}

Vec2 preferred_of(const WalkerScratch& scratch, std::size_t slot) {
    return {scratch.columns.preferred_x[slot], scratch.columns.preferred_y[slot]};
}

/// Half-planes that keep a walker from what is near; at most kMaxWalls.
std::size_t find_walls(
    const CrowdWalker& walker, const BarrierGrid& barriers, float dt,
    std::span<VelocityPlane> planes) {
    std::size_t count = 0;
    const float horizon = std::max(kWallHorizon, dt);
    for (const std::uint32_t i : find_near_barriers(barriers, walker.position)) {
        const BarrierHit hit = find_barrier(barriers.barriers[i], walker.position);
        const float distance = hit.distance - walker.radius;
        if (distance < horizon * walker.max_speed && count < kMaxWalls) {
            planes[count++] = avoid_wall(hit.toward, distance, horizon);
        }
    }
    return count;
}

/// The velocity of the walker whose half-planes are in `lane`.
Vec2 choose_velocity(
    const CrowdWalker& walker, const Vec2& preferred, const WalkerPlanes& near, std::size_t lane,
    const BarrierGrid& barriers, float dt) {
    std::array<VelocityPlane, kMaxVelocityPlanes> planes;
    const std::size_t walls = find_walls(walker, barriers, dt, planes);
    if (walls == 0 && near.is_met[lane] != 0) {
        return {near.start_x[lane], near.start_y[lane]};
    }
    std::size_t count = walls;
    for (std::size_t k = 0; k < near.count[lane]; ++k) {
        planes[count++] = {{near.normal_x[k][lane], near.normal_y[k][lane]}, near.offset[k][lane]};
    }
    return solve_velocity({planes.data(), count}, walls, preferred, walker.max_speed);
}

/// Calls visit(other) for those that may touch `slot`.
template <typename Visit>
void each_contact(const WalkerScratch& scratch, std::size_t slot, const Visit& visit) {
    const WalkerContacts& contacts = scratch.contacts[slot / kCrowdGrain];
    const std::size_t i = slot % kCrowdGrain;
    for (std::uint32_t k = contacts.begins[i]; k < contacts.begins[i + 1]; ++k) {
        visit(contacts.others[k]);
    }
}

/// A pass of Jacobi's method over a slot: its new position, and the overlap that it had.
Vec2 push_from_contacts(
    const WalkerScratch& scratch, std::size_t slot, float max_move, float& deepest) {
    const CrowdWalker& walker = scratch.slots[slot];
    const Vec2 position = scratch.moved[slot];
    const float weight = standing_priority(walker);
    Vec2 push(0);
    float count = 0;
    each_contact(scratch, slot, [&](std::uint32_t i) {
        const CrowdWalker& other = scratch.slots[i];
        const Vec2 offset = position - scratch.moved[i];
        const float distance2 = glm::dot(offset, offset);
        const float reach = walker.radius + other.radius + kPushSkin;
        if (distance2 < square(reach)) {
            const float distance = std::sqrt(distance2);
            const Vec2 away =
                distance > 1e-6f ? offset / distance : parting_direction(walker.key, other.key);
            const float other_weight = standing_priority(other);
            push += ((reach - distance) * other_weight / (weight + other_weight)) * away;
            count += 1;
            deepest = std::max(deepest, reach - kPushSkin - distance);
        }
    });
    Vec2 moved = position;
    if (count > 0) {
        moved += push * (count > 2 ? 2 / count : 1.0f);
    }
    for (const std::uint32_t i : find_near_barriers(scratch.barriers, moved)) {
        const BarrierHit hit = find_barrier(scratch.barriers.barriers[i], moved);
        const float inside = walker.radius - hit.distance;
        if (inside > 0) {
            moved -= inside * hit.toward;
            deepest = std::max(deepest, inside);
        }
    }
    const Vec2 move = moved - walker.position;
    const float length2 = glm::dot(move, move);
    return length2 > square(max_move) ? walker.position + move * (max_move / std::sqrt(length2))
                                      : moved;
}

/// Whether a walker now overlaps another, which it did not before.
bool is_new_overlap(const WalkerScratch& scratch, std::size_t slot) {
    bool is_new = false;
    const CrowdWalker& walker = scratch.slots[slot];
    const Vec2 position = scratch.held[slot] != 0 ? walker.position : scratch.moved[slot];
    each_contact(scratch, slot, [&](std::uint32_t i) {
        const CrowdWalker& other = scratch.slots[i];
        const Vec2 now = position - (scratch.held[i] != 0 ? other.position : scratch.moved[i]);
        const float distance2 = glm::dot(now, now);
        const float limit2 = square(walker.radius + other.radius - kOverlapTolerance);
        if (distance2 < limit2) {
            const Vec2 before = walker.position - other.position;
            is_new = is_new || glm::dot(before, before) >= limit2;
        }
    });
    return is_new;
}

template <typename Body>
void each_slot_range(std::size_t count, const Body& body) {
    parallel_for(count, kCrowdGrain, body);
}

/// Whether nobody overlaps afterwards; some may where it takes more passes.
bool push_out_overlaps(WalkerScratch& scratch, float max_move) {
    const std::size_t count = scratch.slots.size();
    scratch.passes = 0;
    while (scratch.passes < kMaxPushes) {
        each_slot_range(count, [&](std::size_t begin, std::size_t end) {
            float deepest = 0;
            for (std::size_t i = begin; i < end; ++i) {
                scratch.pushed[i] = push_from_contacts(scratch, i, max_move, deepest);
            }
            scratch.deepest[begin / kCrowdGrain] = deepest;
        });
        if (*std::max_element(scratch.deepest.begin(), scratch.deepest.end()) <= 0) {
            return true;
        }
        scratch.moved.swap(scratch.pushed);
        ++scratch.passes;
    }
    return false;
}

/// Who newly overlaps another stays where it was; so may then others, until all is well.
void hold_back(WalkerScratch& scratch) {
    const std::size_t count = scratch.slots.size();
    scratch.held.assign(count, 0);
    thread_local std::vector<std::uint8_t> next_memory;
    std::vector<std::uint8_t>& next = next_memory;
    for (bool changes = true; changes;) {
        next.resize(count);
        each_slot_range(count, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                next[i] = static_cast<std::uint8_t>(
                    scratch.held[i] != 0 || is_new_overlap(scratch, i) ? 1 : 0);
            }
        });
        changes = next != scratch.held;
        scratch.held.swap(next);
    }
    for (std::size_t i = 0; i < count; ++i) {
        if (scratch.held[i] != 0) {
            scratch.moved[i] = scratch.slots[i].position;
            ++scratch.holds;
        }
    }
}

/// The detour grows while a walker gets on too slowly, and fades when it gets on.
float next_detour(
    const CrowdWalker& walker, const Vec2& preferred, const Vec2& velocity, float dt) {
    const float speed2 = glm::dot(walker.wanted, walker.wanted);
    if (speed2 == 0) {
        return 0;
    }
    const float progress = glm::dot(velocity, preferred) / speed2;
    const float rate = progress < kEnoughProgress
                           ? kDetourGrowth * (kEnoughProgress - progress) / kEnoughProgress
                           : -kDetourFading * (progress - kEnoughProgress) / (1 - kEnoughProgress);
    const float limit = kMaxDetour * std::min(walker.distance / kSettling, 1.0f);
    return std::clamp(walker.detour + rate * dt, 0.0f, limit);
}

/// Sorts the walkers into the grid and its columns.
void sort_walkers(std::span<const CrowdWalker> walkers, float dt, WalkerScratch& scratch) {
    const std::size_t count = walkers.size();
    scratch.points.resize(count);
    scratch.keys.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        scratch.points[i] = walkers[i].position;
        scratch.keys[i] = walkers[i].key;
    }
    build_agent_grid(scratch.points, scratch.keys, kCellSize, scratch.grid);
    scratch.slots.resize(count);
    scratch.columns.resize(count);
    scratch.moved.resize(count);
    scratch.pushed.resize(count);
    scratch.contacts.resize((count - 1) / kCrowdGrain + 1);
    scratch.deepest.assign(scratch.contacts.size(), 0);
    WalkerColumns& columns = scratch.columns;
    each_slot_range(count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const CrowdWalker& walker = walkers[scratch.grid.order[i]];
            scratch.slots[i] = walker;
            columns.x[i] = walker.position.x;
            columns.y[i] = walker.position.y;
            columns.vx[i] = walker.velocity.x;
            columns.vy[i] = walker.velocity.y;
            columns.radius[i] = walker.radius;
            columns.weight[i] = standing_priority(walker);
            columns.side[i] = walker.side;
            columns.range[i] = walker.range;
            const Vec2 preferred = preferred_velocity(walker);
            columns.preferred_x[i] = preferred.x;
            columns.preferred_y[i] = preferred.y;
            columns.max_speed[i] = walker.max_speed;
            columns.horizon[i] = std::max(walker.horizon, dt);
            columns.keys[i] = walker.key;
        }
    });
}

/// New positions of a range of slots without push-out.
void move_range(
    WalkerScratch& scratch, const WalkerScene& scene, float dt, std::size_t begin,
    std::size_t end) {
    WalkerContacts& contacts = scratch.contacts[begin / kCrowdGrain];
    contacts.begins.clear();
    contacts.others.clear();
    WalkerPlanes planes;
    for (std::size_t batch = begin; batch < end; batch += kWalkerBatch) {
        const std::size_t batch_end = std::min(batch + kWalkerBatch, end);
        avoid_neighbors(scene, batch, batch_end, contacts, planes);
        for (std::size_t i = batch; i < batch_end; ++i) {
            const std::size_t lane = i - batch;
            const CrowdWalker& walker = scratch.slots[i];
            const Vec2 velocity = choose_velocity(
                walker, preferred_of(scratch, i), planes, lane, scratch.barriers, dt);
            scratch.moved[i] = walker.position + dt * velocity;
        }
    }
    contacts.begins.push_back(static_cast<std::uint32_t>(contacts.others.size()));
}

}  // namespace

Vec2 jittered_velocity(const CrowdWalker& walker, std::uint64_t seed, std::uint64_t frame) {
    if (walker.wanted == Vec2(0)) {
        return Vec2(0);
    }
    Random random(seed, walker.key, name_hash("crowd jitter"), frame / kJitterFrames);
    const float blocked = walker.detour / kMaxDetour;
    const float size =
        kMinJitter + kBlockedJitter * blocked * std::sqrt(glm::dot(walker.wanted, walker.wanted));
    Vec2 velocity = walker.wanted;
    velocity.x += random.uniform(-size, size);
    velocity.y += random.uniform(-size, size);
    return velocity;
}

void step_crowd(
    std::span<CrowdWalker> walkers, std::span<const CrowdBarrier> barriers, float dt,
    WalkerScratch& scratch) {
    if (walkers.empty() || !(dt > 0)) {
        return;
    }
    float max_radius = 0;
    float max_speed = 0;
    for (const CrowdWalker& walker : walkers) {
        max_radius = std::max(max_radius, walker.radius);
        max_speed = std::max(max_speed, walker.max_speed);
    }
    sort_walkers(walkers, dt, scratch);
    const float max_move = max_speed * dt + 2 * kPushSkin;
    update_barrier_grid(
        barriers, max_radius + max_move + std::max(kWallHorizon, dt) * max_speed, scratch.barriers);
    const WalkerScene scene = {
        .grid = scratch.grid,
        .columns = scratch.columns,
        .contact_time = std::max(kContactTime, dt),
        .personal = kPersonalSpace,
        .contact_reach = 2 * max_move,
        .max_radius = max_radius};
    each_slot_range(walkers.size(), [&](std::size_t begin, std::size_t end) {
        move_range(scratch, scene, dt, begin, end);
    });
    scratch.holds = 0;
    if (!push_out_overlaps(scratch, max_move)) {
        hold_back(scratch);
    }
    each_slot_range(walkers.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            CrowdWalker& walker = walkers[scratch.grid.order[i]];
            Vec2 velocity = (scratch.moved[i] - walker.position) / dt;
            const float speed2 = glm::dot(velocity, velocity);
            if (speed2 > square(walker.max_speed)) {
                velocity *= walker.max_speed / std::sqrt(speed2);
            }
            walker.detour = next_detour(walker, preferred_of(scratch, i), velocity, dt);
            walker.velocity = velocity;
            walker.position = scratch.moved[i];
        }
    });
}

}  // namespace limn
