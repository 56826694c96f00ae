#pragma once

#include "ecs/base/math.h"
#include "systems/crowd/agent_grid.h"
#include "systems/crowd/barrier_grid.h"
#include "systems/crowd/crowd_barrier.h"
#include "systems/crowd/walker_kernels.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// One step of many walkers in the plane: neighbors from a grid, velocities by reciprocal avoidance
// (orca.h), then push-out, after which nobody overlaps who did not before. Against deadlocks, which
// avoidance alone does not resolve, a walker that gets on too slowly turns to one side, the same
// for all that meet: a crowd that converges on a point becomes a roundabout. Who stands makes way.
// Nothing depends on the order of the walkers or on the number of threads.

struct CrowdWalker {
    Vec2 position = {0, 0};     ///< [m]; a step moves it
    Vec2 velocity = {0, 0};     ///< [m/s]; of the last step
    Vec2 wanted = {0, 0};       ///< velocity without others [m/s]; 0: stands
    float distance = INFINITY;  ///< to its goal [m]: near it, a blocked walker turns aside less
    float radius = 0.3f;        ///< [m]
    float max_speed = 2;        ///< [m/s]
    float horizon = 2;          ///< how far ahead it avoids others [s]
    float range = 5;            ///< within which it sees others, from center to center [m]
    float priority = 1;         ///< > 0: of two, the one with more evades less
    float side = 1;         ///< to which it turns when blocked: 1 counterclockwise, -1 clockwise
    float detour = 0;       ///< state: how far it has turned there, 0 .. kMaxDetour [rad]
    std::uint64_t key = 0;  ///< differs from those of others, and orders them
};

inline constexpr float kMaxDetour = 1.2f;

/// What a walker wants with a jitter that lasts half a second, stronger where it is blocked: it
/// breaks symmetries that would hold a crowd up forever. 0 stays 0.
[[nodiscard]] Vec2
jittered_velocity(const CrowdWalker& walker, std::uint64_t seed, std::uint64_t frame);

/// Memory of step_crowd(), reused from step to step; holds no state.
struct WalkerScratch {
    AgentGrid grid{};
    BarrierGrid barriers{};
    std::vector<Vec2> points{};
    std::vector<std::uint64_t> keys{};
    std::vector<CrowdWalker> slots{};  ///< the walkers in the order of the grid
    WalkerColumns columns{};           ///< likewise
    std::vector<Vec2> moved{};         ///< their new positions
    std::vector<Vec2> pushed{};
    std::vector<WalkerContacts> contacts{};  ///< by ranges of kCrowdGrain slots
    std::vector<float> deepest{};            ///< overlap by range [m]
    std::vector<std::uint8_t> held{};
    int passes = 0;  ///< of the last push-out
    int holds = 0;   ///< walkers that it kept where they were
};

/// Moves all walkers by `dt` [s]; none if it is 0. All values are finite.
void step_crowd(
    std::span<CrowdWalker> walkers, std::span<const CrowdBarrier> barriers, float dt,
    WalkerScratch& scratch);

}  // namespace limn
