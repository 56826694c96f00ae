#include "systems/water/water_ripple_system.h"

#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "ecs/components/water_frame.h"
#include "systems/water/water_ripple_field.h"
#include "systems/water/water_ripple_walls.h"
#include "systems/water/water_shape.h"

#include <algorithm>
#include <cmath>

namespace limn {

namespace {

constexpr float kBulgeReach = 1.5f;      ///< of the bulge, in half extents of the body
constexpr float kDropCells = 3.0f;       ///< radius of what a rain drop disturbs
constexpr float kMostDrops = 100000.0f;  ///< in a step

WaterBulge bulge_of(const WaterTouch& touch, const Affine& world, const WaterFrame& frame) {
    const WaterShape shape = place_shape(touch, world, frame);
    WaterBulge bulge;
    bulge.center = {shape.center.x, shape.center.z};
    bulge.radius = kBulgeReach * Vec2(shape.reach.x, shape.reach.z);
    bulge.volume = volume_below(shape, 0);
    return bulge;
}

struct Body {
    const WaterTouch* touch = nullptr;
    const Affine* place = nullptr;
};

struct Wall {
    const WaterWall* wall = nullptr;
    const Affine* place = nullptr;
};

struct Pool {
    Entity entity;
    const Water* water = nullptr;
    const WaterRipples* ripples = nullptr;
    const Affine* place = nullptr;
    RippleState* state = nullptr;
};

void let_rain(const WaterRipples& ripples, Random& random, float step, RippleState& state) {
    const Vec2 size = state.size();
    const float expected = std::min(ripples.rain * step * size.x * size.y, kMostDrops);
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

void stand_walls(const Pool& pool, std::span<const Wall> walls, const WaterFrame& frame) {
    thread_local std::vector<PlacedWall> placed;
    placed.clear();
    for (const Wall& wall : walls) {
        const auto one =
            place_wall(*wall.wall, *wall.place, frame, pool.water->depth, pool.state->size());
        if (one) {
            placed.push_back(*one);
        }
    }
    set_ripple_walls(*pool.state, placed, pool.ripples->border);
}

void step_pool(
    const Pool& pool,
    std::span<const Body> bodies,
    std::span<const Wall> walls,
    Random& random,
    float step) {
    RippleState& state = *pool.state;
    if (!fits(state, *pool.water, *pool.ripples)) {
        state = make_ripples(*pool.water, *pool.ripples, step);
    }
    thread_local std::vector<WaterBulge> bulges;
    bulges.clear();
    const WaterFrame frame = water_frame(*pool.place);
    stand_walls(pool, walls, frame);
    for (const Body& body : bodies) {
        bulges.push_back(bulge_of(*body.touch, *body.place, frame));
    }
    displace_ripples(state, bulges);
    let_rain(*pool.ripples, random, step, state);
    step_ripples(state, *pool.ripples, step);
}

}  // namespace

void add_ripple_states(
    Query<const Water, const WaterRipples, Without<RippleState>> bare,
    Res<const FrameTime> time,
    Commands commands) {
    bare.each([&](Entity entity, const Water& water, const WaterRipples& ripples) {
        commands.add(entity, make_ripples(water, ripples, time->step));
    });
}

void update_water_ripples(
    Query<const Water, const WaterRipples, const WorldTransform, RippleState> waters,
    Query<const WaterTouch, const WorldTransform> bodies,
    Query<const WaterWall, const WorldTransform> walls,
    Res<const RandomSeed> seed,
    Res<const FrameTime> time) {
    thread_local std::vector<Body> touching;  // all keep their memory from step to step
    thread_local std::vector<Wall> standing;
    thread_local std::vector<Pool> pools;
    touching.clear();
    standing.clear();
    pools.clear();
    bodies.each([&](const WaterTouch& touch, const WorldTransform& place) {
        touching.push_back({&touch, &place.world});
    });
    walls.each([&](const WaterWall& wall, const WorldTransform& place) {
        standing.push_back({&wall, &place.world});
    });
    waters.each([&](Entity entity,
                    const Water& water,
                    const WaterRipples& ripples,
                    const WorldTransform& place,
                    RippleState& state) {
        pools.push_back({entity, &water, &ripples, &place.world, &state});
    });
    const std::vector<Body>& all_bodies = touching;
    const std::vector<Wall>& all_walls = standing;
    const std::vector<Pool>& all_pools = pools;
    parallel_for(all_pools.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (const Pool& pool : std::span(all_pools).subspan(begin, end - begin)) {
            Random random(
                seed->seed, pool.entity.bits(), name_hash("update_water_ripples"), time->frame);
            step_pool(pool, all_bodies, all_walls, random, time->step);
        }
    });
}

}  // namespace limn
