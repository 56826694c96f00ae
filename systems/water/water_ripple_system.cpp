#include "systems/water/water_ripple_system.h"

#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "ecs/components/water_frame.h"
#include "systems/water/water_ripple_field.h"

#include <algorithm>
#include <cmath>

namespace limn {

namespace {

constexpr float kBulgeReach = 1.5f;      ///< of the bulge, in half extents of the body
constexpr float kDropCells = 3.0f;       ///< radius of what a rain drop disturbs
constexpr float kMostDrops = 100000.0f;  ///< in a step

/// Share of a ball's volume that is below a plane at `share` of its height.
float cap_volume(float share) {
    return share * share * (3 - 2 * share);
}

WaterBulge bulge_of(const WaterTouch& touch, const Affine& world, const WaterFrame& frame) {
    const Vec3 center = frame.local(transform_point(world, touch.offset));
    const bool ball = touch.shape == TouchShape::Ball;
    Vec3 axes[3];
    for (int i = 0; i < 3; ++i) {
        const Vec3 axis(world.row[0][i], world.row[1][i], world.row[2][i]);
        axes[i] = frame.turned_in(axis) * (ball ? touch.half.x : touch.half[i]);
    }
    // How far it reaches along each axis of the water: an ellipsoid and a box of these axes.
    Vec3 reach;
    for (int i = 0; i < 3; ++i) {
        const Vec3 along(axes[0][i], axes[1][i], axes[2][i]);
        reach[i] =
            ball ? glm::length(along) : std::abs(along.x) + std::abs(along.y) + std::abs(along.z);
    }
    const float below = std::clamp((reach.y - center.y) / std::max(2 * reach.y, 1e-6f), 0.0f, 1.0f);
    const float whole = (ball ? 4.0f / 3.0f * kPi : 8.0f)
                        * std::abs(glm::dot(axes[0], glm::cross(axes[1], axes[2])));
    WaterBulge bulge;
    bulge.center = {center.x, center.z};
    bulge.radius = kBulgeReach * Vec2(reach.x, reach.z);
    bulge.volume = whole * (ball ? cap_volume(below) : below);
    return bulge;
}

struct Body {
    const WaterTouch* touch = nullptr;
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

void step_pool(const Pool& pool, std::span<const Body> bodies, Random& random, float step) {
    RippleState& state = *pool.state;
    if (!fits(state, *pool.water, *pool.ripples)) {
        state = make_ripples(*pool.water, *pool.ripples, step);
    }
    thread_local std::vector<WaterBulge> bulges;
    bulges.clear();
    const WaterFrame frame = water_frame(*pool.place);
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
    Res<const RandomSeed> seed,
    Res<const FrameTime> time) {
    thread_local std::vector<Body> touching;  // both keep their memory from step to step
    thread_local std::vector<Pool> pools;
    touching.clear();
    pools.clear();
    bodies.each([&](const WaterTouch& touch, const WorldTransform& place) {
        touching.push_back({&touch, &place.world});
    });
    waters.each([&](Entity entity,
                    const Water& water,
                    const WaterRipples& ripples,
                    const WorldTransform& place,
                    RippleState& state) {
        pools.push_back({entity, &water, &ripples, &place.world, &state});
    });
    const std::vector<Body>& all_bodies = touching;
    const std::vector<Pool>& all_pools = pools;
    parallel_for(all_pools.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (const Pool& pool : std::span(all_pools).subspan(begin, end - begin)) {
            Random random(
                seed->seed, pool.entity.bits(), name_hash("update_water_ripples"), time->frame);
            step_pool(pool, all_bodies, random, time->step);
        }
    });
}

}  // namespace limn
