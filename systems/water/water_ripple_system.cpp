#include "systems/water/water_ripple_system.h"

#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "ecs/components/water_frame.h"
#include "systems/water/water_ripple_field.h"
#include "systems/water/water_ripple_walls.h"
#include "systems/water/water_touch.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {

namespace {

constexpr float kDropCells = 3.0f;      ///< radius of a rain drop's impulse [cells]
constexpr float kMaxDrops = 100000.0f;  ///< per step

/// Sorted by world x, so that a pool only visits those near it.
struct Touching {
    float x = 0;
    std::size_t order = 0;
    TouchingShape shape;
};
struct Wall {
    float x = 0;
    std::size_t order = 0;
    const WaterWall* wall = nullptr;
    const Affine* transform = nullptr;
};

/// All bodies and walls.
struct Surroundings {
    std::vector<Touching> bodies;
    std::vector<Wall> walls;
    float widest = 0;  ///< largest radius of a wall [m]
};

template <typename T>
void sort_along_x(std::vector<T>& all) {
    all.erase(
        std::remove_if(all.begin(), all.end(), [](const T& one) { return !std::isfinite(one.x); }),
        all.end());
    std::sort(all.begin(), all.end(), [](const T& a, const T& b) {
        return a.x != b.x ? a.x < b.x : a.order < b.order;
    });
}

/// Those with x within `radius` [m] of `center`.
template <typename T>
std::span<const T> near_x(const std::vector<T>& sorted, float center, float radius) {
    const auto below = [](const T& one, float x) { return one.x < x; };
    const auto first = std::lower_bound(sorted.begin(), sorted.end(), center - radius, below);
    const auto last = std::upper_bound(
        first, sorted.end(), center + radius, [](float x, const T& one) { return x < one.x; });
    return {first, last};
}

struct Pool {
    Entity entity;
    const WaterRipples* ripples = nullptr;
    WaterSurface surface;  ///< without ripples
    RippleState* state = nullptr;
};

void add_rain(const WaterRipples& ripples, Random& random, float step, RippleState& state) {
    const Vec2 size = state.size();
    const float expected = std::min(ripples.rain * step * size.x * size.y, kMaxDrops);
    const int drops = static_cast<int>(std::floor(expected + random.uniform()));
    for (int i = 0; i < drops; ++i) {
        const float x = random.uniform(-0.5f, 0.5f);
        const float z = random.uniform(-0.5f, 0.5f);
        state.impulses.push_back(
            {.center = Vec2(x, z) * size,
             .radius = kDropCells * state.cell,
             .height = -ripples.rain_height});
    }
}

void update_walls(const Pool& pool, std::span<const Wall> walls) {
    thread_local std::vector<PlacedWall> placed;
    placed.clear();
    const WaterSurface& surface = pool.surface;
    for (const Wall& wall : walls) {
        const auto one = place_wall(
            *wall.wall, *wall.transform, surface.frame, surface.water.depth, pool.state->size());
        if (one) {
            placed.push_back(*one);
        }
    }
    set_ripple_walls(*pool.state, placed, pool.ripples->border);
}

void step_pool(const Pool& pool, const Surroundings& around, Random& random, float step) {
    RippleState& state = *pool.state;
    if (!fits(state, pool.surface.water, *pool.ripples)) {
        state = make_ripples(pool.surface.water, *pool.ripples, step);
    }
    const float x = pool.surface.frame.origin.x;
    const float radius = 0.5f * glm::length(state.size()) + state.cell;
    update_walls(pool, near_x(around.walls, x, radius + around.widest));
    // The level of open water does not rise.
    const bool rises = pool.ripples->border == RippleBorder::Reflecting;
    const float level = rises ? static_cast<float>(state.level) : 0.0f;
    thread_local std::vector<WaterBulge> bulges;
    bulges.clear();
    for (const Touching& body : near_x(around.bodies, x, radius)) {
        bulges.push_back(bulge_of(body.shape, pool.surface, level, state.size()));
    }
    displace_ripples(state, bulges);
    add_rain(*pool.ripples, random, step, state);
    step_ripples(state, *pool.ripples, step);
}

}  // namespace

void add_ripple_states(
    Query<const Water, const WaterRipples, Without<RippleState>> bare, Res<const FrameTime> time,
    Commands commands) {
    bare.each([&](Entity entity, const Water& water, const WaterRipples& ripples) {
        commands.add(entity, make_ripples(water, ripples, time->step));
    });
}

void update_water_ripples(
    Query<
        const Water, const WaterRipples, const WorldTransform, Optional<const OceanState>,
        Optional<const WaveTable>, RippleState>
        waters,
    Query<
        const WaterTouch, const WorldTransform, Optional<const TouchParts>,
        Optional<const Deformed>>
        bodies,
    Query<const Pose> poses, Query<const WaterWall, const WorldTransform> walls,
    Res<const Assets> assets, Res<const RandomSeed> seed, Res<const FrameTime> time) {
    thread_local Surroundings surroundings;  // memory of all three is reused
    thread_local std::vector<TouchingShape> shapes;
    thread_local std::vector<Pool> pools;
    surroundings.bodies.clear();
    surroundings.walls.clear();
    surroundings.widest = 0;
    pools.clear();
    shapes.clear();
    bodies.each([&](const WaterTouch& touch, const WorldTransform& transform,
                    const TouchParts* parts, const Deformed* deformed) {
        const bool skinned = deformed != nullptr && deformed->skin.index < assets->skins.size();
        add_touching_shapes(
            touch, transform.world, parts, skinned ? &assets->skins[deformed->skin.index] : nullptr,
            skinned ? poses.find<const Pose>(deformed->character) : nullptr, shapes);
    });
    for (const TouchingShape& shape : shapes) {
        const float x = transform_point(shape.world, shape.offset).x;
        surroundings.bodies.push_back({x, surroundings.bodies.size(), shape});
    }
    walls.each([&](const WaterWall& wall, const WorldTransform& transform) {
        const float x = transform_point(transform.world, wall.offset).x;
        surroundings.walls.push_back({x, surroundings.walls.size(), &wall, &transform.world});
        float square_sum = 0;
        for (const Vec4& row : transform.world.row) {
            const Vec3 side = Vec3(row) * wall.half;
            square_sum += glm::dot(side, side);
        }
        surroundings.widest = std::max(surroundings.widest, std::sqrt(square_sum));
    });
    sort_along_x(surroundings.bodies);
    sort_along_x(surroundings.walls);
    waters.each([&](Entity entity, const Water& water, const WaterRipples& ripples,
                    const WorldTransform& transform, const OceanState* ocean,
                    const WaveTable* waves, RippleState& state) {
        const WaterSurface surface = {water_frame(transform.world), water, ocean, waves};
        pools.push_back({entity, &ripples, surface, &state});
    });
    const Surroundings& around = surroundings;
    const std::vector<Pool>& all_pools = pools;
    parallel_for(all_pools.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (const Pool& pool : std::span(all_pools).subspan(begin, end - begin)) {
            Random random(
                seed->seed, pool.entity.bits(), name_hash("update_water_ripples"), time->frame);
            step_pool(pool, around, random, time->step);
        }
    });
}

}  // namespace limn
