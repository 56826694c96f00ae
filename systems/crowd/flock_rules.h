#pragma once

#include "ecs/base/math.h"
#include "ecs/components/flock.h"
#include "systems/crowd/agent_grid.h"
#include "systems/crowd/crowd_barrier.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Flocking: C. Reynolds, "Flocks, Herds, and Schools: A Distributed Behavioral Model", SIGGRAPH
// 1987 (char.flock). Of the neighbors j of boid i, within the radius and the cone of view,
//
//     a1 = sum (x_i - x_j) / |x_i - x_j|^2    a2 = mean v_j - v_i    a3 = mean x_j - x_i
//
// and a4 is a direction that wanders. In this order each k a is added until the sum of their
// lengths is max_acceleration. Nothing depends on the order of the boids or on the number of
// threads.

/// A boid of one flock.
struct FlockMember {
    Vec3 position = {0, 0, 0};  ///< [m]
    Vec3 velocity = {0, 0, 0};  ///< [m/s]
    Vec3 wander = {0, 0, 1};    ///< unit
    std::uint64_t key = 0;      ///< differs from those of others, and orders them
};

/// The rules' accelerations k a, first to last [m/s2].
using FlockRules = std::array<Vec3, 4>;

/// Their sum, of which the last one that is added is shortened so that all lengths add up to
/// `budget` at most.
[[nodiscard]] Vec3 allocate_acceleration(const FlockRules& rules, float budget);

/// Memory of step_flock(), reused from step to step; holds no state.
struct FlockScratch {
    AgentGrid grid{};
    std::vector<Vec2> points{};
    std::vector<std::uint64_t> keys{};
    std::vector<FlockMember> slots{};
    std::vector<Vec3> accelerations{};
};

/// The rules of a boid: scratch.slots[slot], after arrange_flock().
[[nodiscard]] FlockRules find_flock_rules(
    const FlockParams& params, const Vec3& home, std::span<const CrowdBarrier> barriers,
    const FlockScratch& scratch, std::size_t slot);

/// Sorts the boids into the grid.
void arrange_flock(
    const FlockParams& params, std::span<const FlockMember> boids, FlockScratch& scratch);

/// Moves all boids of a flock by `dt` [s] > 0. All values are finite.
void step_flock(
    const FlockParams& params, const Vec3& home, std::span<const CrowdBarrier> barriers, float dt,
    std::span<FlockMember> boids, FlockScratch& scratch);

}  // namespace limn
