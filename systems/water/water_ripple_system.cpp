#include "systems/water/water_ripple_system.h"

#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "ecs/components/water_frame.h"
#include "systems/water/water_ripple_field.h"
#include "systems/water/water_ripple_walls.h"
#include "systems/water/water_touch.h"

#include <algorithm>
#include <cmath>

namespace limn {

namespace {

constexpr float kDropCells = 3.0f;       ///< radius of what a rain drop disturbs
constexpr float kMostDrops = 100000.0f;  ///< in a step

struct Wall {
    const WaterWall* wall = nullptr;
    const Affine* place = nullptr;
};

struct Pool {
    Entity entity;
    const WaterRipples* ripples = nullptr;
    WaterSurface surface;  ///< without its ripples
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
        const auto one = place_wall(
            *wall.wall, *wall.place, frame, pool.surface.water.depth, pool.state->size());
        if (one) {
            placed.push_back(*one);
        }
    }
    set_ripple_walls(*pool.state, placed, pool.ripples->border);
}

void step_pool(
    const Pool& pool,
    std::span<const TouchingShape> bodies,
    std::span<const Wall> walls,
    Random& random,
    float step) {
    RippleState& state = *pool.state;
    if (!fits(state, pool.surface.water, *pool.ripples)) {
        state = make_ripples(pool.surface.water, *pool.ripples, step);
    }
    thread_local std::vector<WaterBulge> bulges;
    bulges.clear();
    stand_walls(pool, walls, pool.surface.frame);
    // Open water is too large to rise.
    const bool rises = pool.ripples->border == RippleBorder::Reflecting;
    const float level = rises ? static_cast<float>(state.level) : 0.0f;
    for (const TouchingShape& body : bodies) {
        bulges.push_back(bulge_of(body, pool.surface, level, state.size()));
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
    Query<
        const Water,
        const WaterRipples,
        const WorldTransform,
        Optional<const OceanState>,
        Optional<const WaveTable>,
        RippleState> waters,
    Query<
        const WaterTouch,
        const WorldTransform,
        Optional<const TouchParts>,
        Optional<const Deformed>> bodies,
    Query<const Pose> poses,
    Query<const WaterWall, const WorldTransform> walls,
    Res<const Assets> assets,
    Res<const RandomSeed> seed,
    Res<const FrameTime> time) {
    thread_local std::vector<TouchingShape> touching;  // all keep their memory from step to step
    thread_local std::vector<Wall> standing;
    thread_local std::vector<Pool> pools;
    touching.clear();
    standing.clear();
    pools.clear();
    bodies.each([&](const WaterTouch& touch,
                    const WorldTransform& place,
                    const TouchParts* parts,
                    const Deformed* deformed) {
        const bool skinned = deformed != nullptr && deformed->skin.index < assets->skins.size();
        add_touching_shapes(
            touch,
            place.world,
            parts,
            skinned ? &assets->skins[deformed->skin.index] : nullptr,
            skinned ? poses.find<const Pose>(deformed->character) : nullptr,
            touching);
    });
    walls.each([&](const WaterWall& wall, const WorldTransform& place) {
        standing.push_back({&wall, &place.world});
    });
    waters.each([&](Entity entity,
                    const Water& water,
                    const WaterRipples& ripples,
                    const WorldTransform& place,
                    const OceanState* ocean,
                    const WaveTable* waves,
                    RippleState& state) {
        const WaterSurface surface = {water_frame(place.world), water, ocean, waves};
        pools.push_back({entity, &ripples, surface, &state});
    });
    const std::vector<TouchingShape>& all_bodies = touching;
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
