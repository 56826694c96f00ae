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

constexpr std::size_t kCrowdGrain = 256;    // slots per task
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

/// The nearest walkers, ascending: the bits of the distance squared, which order as it does, above
/// the slot, so that equally near ones are in the order of the grid.
struct NearestWalkers {
    std::array<std::uint64_t, kMaxNeighbors> found;
    std::size_t count = 0;  ///< all that were added

    NearestWalkers() { found.fill(~std::uint64_t{0}); }
    [[nodiscard]] bool is_full() const { return count >= kMaxNeighbors; }
    [[nodiscard]] std::size_t size() const { return std::min(count, kMaxNeighbors); }
    [[nodiscard]] std::uint32_t slot(std::size_t i) const {
        return static_cast<std::uint32_t>(found[i]);
    }
    [[nodiscard]] float distance2(std::size_t i) const {
        return std::bit_cast<float>(static_cast<std::uint32_t>(found[i] >> 32));
    }
    /// Without branches, which would be mispredicted.
    void add(std::uint32_t slot, float distance2) {
        std::uint64_t moving = std::uint64_t{std::bit_cast<std::uint32_t>(distance2)} << 32 | slot;
        for (std::uint64_t& kept : found) {
            const std::uint64_t least = std::min(kept, moving);
            moving = std::max(kept, moving);
            kept = least;
        }
        ++count;
    }
};

float standing_priority(const CrowdWalker& walker) {
    return walker.priority * (walker.wanted == Vec2(0) ? kStandingShare : 1.0f);
}

/// Where a walker would go without others: turned by its detour.
Vec2 preferred_velocity(const CrowdWalker& walker) {
    const Vec2 turn = repeatable_cos_sin(walker.side * walker.detour);
    return {
        turn.x * walker.wanted.x - turn.y * walker.wanted.y,
        turn.y * walker.wanted.x + turn.x * walker.wanted.y};
}

/// Calls visit(slot, distance squared) for the others in the cells within `reach`.
template <typename Visit>
void each_near(const WalkerScratch& scratch, std::size_t slot, float reach, const Visit& visit) {
    const Vec2 position = scratch.slots[slot].position;
    const float* const xs = scratch.x.data();
    const float* const ys = scratch.y.data();
    each_run(scratch.grid, position, reach, [&](SlotRun run) {
        for (std::uint32_t i = run.begin; i < run.end; ++i) {
            const float distance2 = square(xs[i] - position.x) + square(ys[i] - position.y);
            if (i != slot) {
                visit(i, distance2);
            }
        }
    });
}

NearestWalkers find_near_walkers(const WalkerScratch& scratch, std::size_t slot, float reach) {
    NearestWalkers nearest;
    const float limit2 = square(reach);
    constexpr std::size_t kBatch = 64;
    std::array<std::uint32_t, kBatch> slots;
    std::array<float, kBatch> distances2;
    std::size_t count = 0;
    const auto add_batch = [&] {
        for (std::size_t i = 0; i < count; ++i) {
            nearest.add(slots[i], distances2[i]);
        }
        count = 0;
    };
    each_near(scratch, slot, reach, [&](std::uint32_t i, float distance2) {
        slots[count] = i;
        distances2[count] = distance2;
        count += distance2 <= limit2 ? 1 : 0;
        if (count == kBatch) {
            add_batch();
        }
    });
    add_batch();
    return nearest;
}

/// In dense crowds the nearest are in the cells around.
NearestWalkers find_neighbors(const WalkerScratch& scratch, std::size_t slot) {
    const CrowdWalker& walker = scratch.slots[slot];
    std::uint32_t around = 0;
    each_run(scratch.grid, walker.position, kCellSize, [&](SlotRun run) {
        around += run.end - run.begin;
    });
    if (around > 2 * kMaxNeighbors && walker.range > kCellSize) {
        const NearestWalkers nearest = find_near_walkers(scratch, slot, kCellSize);
        if (nearest.is_full()) {
            return nearest;
        }
    }
    return find_near_walkers(scratch, slot, walker.range);
}

Vec2 choose_velocity(
    const WalkerScratch& scratch, std::size_t slot, std::span<const CrowdBarrier> barriers,
    float dt) {
    const CrowdWalker& walker = scratch.slots[slot];
    const NearestWalkers nearest = find_neighbors(scratch, slot);
    std::array<VelocityPlane, kMaxVelocityPlanes> planes;
    std::size_t count = 0;
    for (const CrowdBarrier& barrier : barriers) {
        const BarrierHit hit = find_barrier(barrier, walker.position);
        const float distance = hit.distance - walker.radius;
        const float horizon = std::max(kWallHorizon, dt);
        if (distance < horizon * walker.max_speed && count < kMaxWalls) {
            planes[count++] = avoid_wall(hit.toward, distance, horizon);
        }
    }
    const std::size_t walls = count;
    const float weight = standing_priority(walker);
    for (std::size_t i = 0; i < nearest.size(); ++i) {
        const CrowdWalker& other = scratch.slots[nearest.slot(i)];
        const float other_weight = standing_priority(other);
        const bool overlaps =
            nearest.distance2(i) < square(walker.radius + other.radius + kPersonalSpace);
        planes[count++] = avoid_walker(
            {walker.position, walker.velocity, walker.radius + kPersonalSpace},
            {other.position, other.velocity, other.radius},
            {.horizon = std::max(walker.horizon, dt),
             .contact_time = std::max(kContactTime, dt),
             .share = weight == other_weight ? 0.5f : other_weight / (weight + other_weight),
             .side = walker.side == other.side ? walker.side : 0.0f,
             .apart = overlaps ? parting_direction(walker.key, other.key) : Vec2(1, 0)});
    }
    return solve_velocity(
        {planes.data(), count}, walls, preferred_velocity(walker), walker.max_speed);
}

/// Lists who may touch a range of slots in this step: a superset.
void list_contacts(
    const WalkerScratch& scratch, std::size_t begin, std::size_t end, float max_radius,
    float max_move, WalkerScratch::Contacts& contacts) {
    contacts.begins.clear();
    contacts.others.clear();
    for (std::size_t slot = begin; slot < end; ++slot) {
        contacts.begins.push_back(static_cast<std::uint32_t>(contacts.others.size()));
        const CrowdWalker& walker = scratch.slots[slot];
        const float reach = walker.radius + max_radius + 2 * max_move;
        each_near(scratch, slot, reach, [&](std::uint32_t i, float distance2) {
            if (distance2 < square(reach)
                && distance2 < square(walker.radius + scratch.slots[i].radius + 2 * max_move)) {
                contacts.others.push_back(i);
            }
        });
    }
    contacts.begins.push_back(static_cast<std::uint32_t>(contacts.others.size()));
}

/// Calls visit(other) for those that may touch `slot`.
template <typename Visit>
void each_contact(const WalkerScratch& scratch, std::size_t slot, const Visit& visit) {
    const WalkerScratch::Contacts& contacts = scratch.contacts[slot / kCrowdGrain];
    const std::size_t i = slot % kCrowdGrain;
    for (std::uint32_t k = contacts.begins[i]; k < contacts.begins[i + 1]; ++k) {
        visit(contacts.others[k]);
    }
}

/// A pass of Jacobi's method over a slot: its new position, and the overlap that it had.
Vec2 push_from_contacts(
    const WalkerScratch& scratch, std::size_t slot, std::span<const CrowdBarrier> barriers,
    float max_move, float& deepest) {
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
    for (const CrowdBarrier& barrier : barriers) {
        const BarrierHit hit = find_barrier(barrier, moved);
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
bool push_out_overlaps(
    WalkerScratch& scratch, std::span<const CrowdBarrier> barriers, float max_move) {
    const std::size_t count = scratch.slots.size();
    scratch.passes = 0;
    while (scratch.passes < kMaxPushes) {
        each_slot_range(count, [&](std::size_t begin, std::size_t end) {
            float deepest = 0;
            for (std::size_t i = begin; i < end; ++i) {
                scratch.pushed[i] = push_from_contacts(scratch, i, barriers, max_move, deepest);
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
float next_detour(const CrowdWalker& walker, const Vec2& velocity, float dt) {
    const float speed2 = glm::dot(walker.wanted, walker.wanted);
    if (speed2 == 0) {
        return 0;
    }
    const float progress = glm::dot(velocity, preferred_velocity(walker)) / speed2;
    const float rate = progress < kEnoughProgress
                           ? kDetourGrowth * (kEnoughProgress - progress) / kEnoughProgress
                           : -kDetourFading * (progress - kEnoughProgress) / (1 - kEnoughProgress);
    const float limit = kMaxDetour * std::min(walker.distance / kSettling, 1.0f);
    return std::clamp(walker.detour + rate * dt, 0.0f, limit);
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
    const std::size_t count = walkers.size();
    scratch.points.resize(count);
    scratch.keys.resize(count);
    float max_radius = 0;
    float max_speed = 0;
    for (std::size_t i = 0; i < count; ++i) {
        scratch.points[i] = walkers[i].position;
        scratch.keys[i] = walkers[i].key;
        max_radius = std::max(max_radius, walkers[i].radius);
        max_speed = std::max(max_speed, walkers[i].max_speed);
    }
    build_agent_grid(scratch.points, scratch.keys, kCellSize, scratch.grid);
    scratch.slots.resize(count);
    scratch.x.resize(count);
    scratch.y.resize(count);
    scratch.moved.resize(count);
    scratch.pushed.resize(count);
    scratch.contacts.resize((count - 1) / kCrowdGrain + 1);
    scratch.deepest.assign(scratch.contacts.size(), 0);
    for (std::size_t i = 0; i < count; ++i) {
        scratch.slots[i] = walkers[scratch.grid.order[i]];
        scratch.x[i] = scratch.slots[i].position.x;
        scratch.y[i] = scratch.slots[i].position.y;
    }
    const float max_move = max_speed * dt + 2 * kPushSkin;
    each_slot_range(count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec2 velocity = choose_velocity(scratch, i, barriers, dt);
            scratch.moved[i] = scratch.slots[i].position + dt * velocity;
        }
        list_contacts(
            scratch, begin, end, max_radius, max_move, scratch.contacts[begin / kCrowdGrain]);
    });
    scratch.holds = 0;
    if (!push_out_overlaps(scratch, barriers, max_move)) {
        hold_back(scratch);
    }
    for (std::size_t i = 0; i < count; ++i) {
        CrowdWalker& walker = walkers[scratch.grid.order[i]];
        Vec2 velocity = (scratch.moved[i] - walker.position) / dt;
        const float speed2 = glm::dot(velocity, velocity);
        if (speed2 > square(walker.max_speed)) {
            velocity *= walker.max_speed / std::sqrt(speed2);
        }
        walker.detour = next_detour(walker, velocity, dt);
        walker.velocity = velocity;
        walker.position = scratch.moved[i];
    }
}

}  // namespace limn
