#include "systems/crowd/crowd_system.h"

#include "ecs/base/hash.h"
#include "ecs/base/jobs.h"
#include "ecs/base/log.h"
#include "systems/crowd/crowd_floor.h"
#include "systems/crowd/crowd_places.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

// Techniques: char.flock

namespace limn {
namespace {

constexpr float kArrivalTime = 0.5f;    // over which a walker slows down at its goal [s]
constexpr float kHeadingSpeed = 0.15f;  // above which a walker turns to where it goes [m/s]
constexpr std::size_t kWalkerGrain = 512;

Vec2 ground_plane(const Vec3& v) {
    return {v.x, v.z};
}

struct PlacedExit {
    Entity entity{};
    Vec2 center{};
    CrowdExit exit{};
};
struct PlacedSpace {
    Vec2 center{};
    CrowdSpace space{};
};

/// Everything that stands, in this step.
struct CrowdGround {
    std::vector<CrowdBarrier> barriers;
    std::vector<PlacedExit> exits;  ///< by entity
    std::vector<PlacedSpace> spaces;
};

/// A walker of the world, and what update_crowd() writes.
struct PlacedWalker {
    Entity entity;
    const CrowdAgent* agent = nullptr;
    CrowdState* state = nullptr;
    Transform* transform = nullptr;
    CrowdGoal* goal = nullptr;           ///< null: it has none
    const MoveIntent* intent = nullptr;  ///< likewise
    ClipPlayer* player = nullptr;        ///< likewise
    bool is_sound = false;
};

CrowdGround place_ground(
    const Query<const CrowdObstacle>& obstacles, const Query<const CrowdExit>& exits,
    const Query<const CrowdSpace>& spaces, const Placements& placements) {
    CrowdGround ground;
    ground.barriers = place_obstacles(obstacles, placements);
    const auto center_of = [&](Entity entity) {
        const Affine world = placements.world(entity);
        return Vec2(world.row[0].w, world.row[2].w);
    };
    exits.each([&](Entity entity, const CrowdExit& exit) {
        const Vec2 center = center_of(entity);
        if (is_finite(center) && std::isfinite(exit.radius)) {
            ground.exits.push_back({entity, center, exit});
        }
    });
    std::sort(
        ground.exits.begin(), ground.exits.end(),
        [](const PlacedExit& a, const PlacedExit& b) { return a.entity.bits() < b.entity.bits(); });
    spaces.each([&](Entity entity, const CrowdSpace& space) {
        const Vec2 center = center_of(entity);
        if (is_finite(center) && space.size.x > 0 && space.size.y > 0 && space.cell > 0
            && is_finite(space.size) && std::isfinite(space.cell + space.clearance)) {
            ground.spaces.push_back({center, space});
        }
    });
    return ground;
}

const PlacedExit* find_exit(const CrowdGround& ground, Entity entity) {
    const auto found = std::lower_bound(
        ground.exits.begin(), ground.exits.end(), entity,
        [](const PlacedExit& exit, Entity key) { return exit.entity.bits() < key.bits(); });
    return found != ground.exits.end() && found->entity == entity ? &*found : nullptr;
}

std::uint64_t
hash_ways(const CrowdGround& ground, const PlacedSpace& space, const PlacedExit& exit) {
    std::uint64_t hash =
        hash_bytes(ground.barriers.data(), ground.barriers.size() * sizeof(CrowdBarrier));
    const float numbers[] = {space.center.x,     space.center.y,   space.space.size.x,
                             space.space.size.y, space.space.cell, space.space.clearance,
                             exit.center.x,      exit.center.y,    exit.exit.radius};
    return hash_bytes(numbers, sizeof(numbers), hash);
}

/// Fields of all spaces and exits, space by space: computed where something changed.
void find_ways(const CrowdGround& ground, std::vector<CrowdMemory::Ways>& ways) {
    ways.resize(ground.spaces.size() * ground.exits.size());
    std::size_t next = 0;
    for (const PlacedSpace& space : ground.spaces) {
        for (const PlacedExit& exit : ground.exits) {
            CrowdMemory::Ways& own = ways[next++];
            const std::uint64_t inputs = hash_ways(ground, space, exit);
            if (own.inputs == inputs && !own.field.length.empty()) {
                continue;
            }
            own.inputs = inputs;
            own.grid = make_flow_grid(
                space.center, space.space.size, space.space.cell, space.space.clearance,
                ground.barriers);
            own.field = solve_flow_field(own.grid, exit.center, exit.exit.radius);
            if (own.field.moved) {
                log_warn(
                    "crowd_exit at ({}, {}): nothing is free there within the crowd_space; walkers "
                    "go to the nearest free place",
                    exit.center.x, exit.center.y);
            }
        }
    }
}

/// The direction to an exit from a point: along the ways of the first space that has some there.
Vec2 find_way(
    const CrowdGround& ground, const std::vector<CrowdMemory::Ways>& ways, const PlacedExit& exit,
    const Vec2& point) {
    const auto index = static_cast<std::size_t>(&exit - ground.exits.data());
    for (std::size_t s = 0; s < ground.spaces.size(); ++s) {
        const CrowdMemory::Ways& own = ways[s * ground.exits.size() + index];
        const Vec2 flow = find_flow(own.grid, own.field, point);
        if (flow != Vec2(0)) {
            return flow;
        }
    }
    return Vec2(0);
}

/// Sets what a walker wants; those that arrive at an exit turn to the next.
void want_goal(
    const CrowdGround& ground, const CrowdMemory& memory, const Placements& placements,
    const CrowdAgent& agent, CrowdGoal& goal, CrowdWalker& walker) {
    const Vec2 position = walker.position;
    const PlacedExit* exit = find_exit(ground, goal.exit);
    if (exit != nullptr && exit->exit.next != Entity{}) {
        const Vec2 offset = exit->center - position;
        if (glm::dot(offset, offset) <= square(exit->exit.radius)) {
            goal.exit = exit->exit.next;
            exit = find_exit(ground, goal.exit);
        }
    }
    Vec2 target = ground_plane(goal.point);
    float arrive = goal.arrive;
    if (exit != nullptr) {
        target = exit->center;
        arrive = std::max(arrive, exit->exit.radius);
    } else if (placements.has(goal.exit)) {
        const Affine world = placements.world(goal.exit);
        target = {world.row[0].w, world.row[2].w};
    }
    const Vec2 offset = target - position;
    const float distance2 = glm::dot(offset, offset);
    if (!(distance2 > square(arrive))) {  // also where the target is NaN
        return;
    }
    const float distance = std::sqrt(distance2);
    const bool goes_on = exit != nullptr && exit->exit.next != Entity{};
    const float speed = goes_on ? agent.speed : std::min(agent.speed, distance / kArrivalTime);
    Vec2 way = exit != nullptr ? find_way(ground, memory.ways, *exit, position) : Vec2(0);
    if (way == Vec2(0)) {
        way = offset / distance;
    }
    walker.wanted = speed * way;
    if (!goes_on) {
        walker.distance = distance;
    }
}

bool is_sound_walker(const CrowdWalker& walker) {
    return is_finite(walker.position) && is_finite(walker.velocity) && is_finite(walker.wanted)
           && std::isfinite(
               walker.radius + walker.max_speed + walker.horizon + walker.range + walker.priority
               + walker.detour)
           && walker.radius >= 0 && walker.max_speed >= 0 && walker.horizon > 0 && walker.range >= 0
           && walker.priority > 0;
}

void write_walker(
    const CrowdWalker& walker, const PlacedWalker& placed, const CrowdFloor& floor,
    const Assets& assets, float step) {
    placed.state->velocity = walker.velocity;
    placed.state->detour = walker.detour;
    placed.transform->position.x = walker.position.x;
    placed.transform->position.z = walker.position.y;
    const float speed2 = glm::dot(walker.velocity, walker.velocity);
    if (placed.agent->climb > 0) {
        float& height = placed.transform->position.y;
        height = follow_floor(
            height,
            find_floor(floor, placed.transform->position, placed.agent->climb).value_or(height),
            std::sqrt(speed2), step);
    }
    const Vec2 facing = placed.intent != nullptr ? ground_plane(placed.intent->facing) : Vec2(0);
    const Vec2 toward = facing != Vec2(0)                ? facing
                        : speed2 > square(kHeadingSpeed) ? walker.velocity
                                                         : Vec2(0);
    placed.transform->rotation =
        turn_heading(placed.transform->rotation, toward, placed.agent->turn_speed * step);
    ClipPlayer* const player = placed.player;
    if (player != nullptr && placed.agent->stride > 0 && player->clip.index < assets.clips.size()) {
        player->speed = stride_rate(
            std::sqrt(speed2), placed.agent->stride, assets.clips[player->clip.index].duration);
    }
}

float shared_side(PassingSide side, std::uint64_t seed) {
    // Seen from above with z down, as the plane (x, z) is, a turn to the right is counterclockwise.
    const bool right = side == PassingSide::Seeded
                           ? (hash_combine(seed, name_hash("passing side")) & 1) != 0
                           : side == PassingSide::Right;
    return right ? 1.0f : -1.0f;
}

/// As it stands, without a goal.
CrowdWalker read_walker(const PlacedWalker& placed, std::uint64_t seed) {
    const CrowdAgent& agent = *placed.agent;
    CrowdWalker walker;
    walker.position = ground_plane(placed.transform->position);
    walker.velocity = placed.state->velocity;
    walker.radius = agent.radius;
    walker.max_speed = agent.max_speed;
    walker.horizon = agent.horizon;
    walker.range = agent.neighbor_distance;
    walker.priority = agent.priority;
    walker.side = shared_side(agent.side, seed);
    walker.detour = std::clamp(placed.state->detour, 0.0f, kMaxDetour);
    walker.key = placed.entity.bits();
    if (placed.goal == nullptr && placed.intent != nullptr) {
        walker.wanted = ground_plane(placed.intent->velocity);
    }
    return walker;
}

void remove_unsound(std::vector<PlacedWalker>& placed, std::vector<CrowdWalker>& walkers) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < placed.size(); ++i) {
        if (placed[i].is_sound) {
            if (kept != i) {
                placed[kept] = placed[i];
                walkers[kept] = walkers[i];
            }
            ++kept;
        }
    }
    placed.resize(kept);
    walkers.resize(kept);
}

}  // namespace

void add_crowd_states(Query<const CrowdAgent, Without<CrowdState>> bare, Commands commands) {
    bare.each([&](Entity entity, const CrowdAgent&) { commands.add(entity, CrowdState{}); });
}

void update_crowd(
    WalkerQuery walkers, Query<const CrowdObstacle> obstacles, Query<const CrowdExit> exits,
    Query<const CrowdSpace> spaces, GroundQueries grounds, Res<const Assets> assets,
    Res<CrowdMemory> memory, Res<const RandomSeed> seed, Res<const FrameTime> time) {
    if (walkers.empty()) {
        return;
    }
    const Placements placements(grounds.transforms, grounds.parents);
    const CrowdFloor floor = place_floor(grounds);
    const CrowdGround ground = place_ground(obstacles, exits, spaces, placements);
    find_ways(ground, memory->ways);
    thread_local std::vector<PlacedWalker> placed_memory;  // reused between steps
    std::vector<PlacedWalker>& placed = placed_memory;
    placed.clear();
    walkers.each([&](Entity entity, const CrowdAgent& agent, CrowdState& state,
                     Transform& transform, CrowdGoal* goal, const MoveIntent* intent,
                     ClipPlayer* player) {
        placed.push_back({entity, &agent, &state, &transform, goal, intent, player});
    });
    memory->walkers.resize(placed.size());
    parallel_for(placed.size(), kWalkerGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            CrowdWalker& walker = memory->walkers[i];
            walker = read_walker(placed[i], seed->seed);
            if (placed[i].goal != nullptr) {
                want_goal(ground, *memory, placements, *placed[i].agent, *placed[i].goal, walker);
            }
            walker.wanted = jittered_velocity(walker, seed->seed, time->frame);
            placed[i].is_sound = is_sound_walker(walker);
        }
    });
    remove_unsound(placed, memory->walkers);
    step_crowd(memory->walkers, ground.barriers, time->step, memory->scratch);
    parallel_for(placed.size(), kWalkerGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            write_walker(memory->walkers[i], placed[i], floor, *assets, time->step);
        }
    });
}

}  // namespace limn
