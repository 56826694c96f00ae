#include "systems/water/water_stone_system.h"

#include "ecs/components/buoyancy.h"
#include "systems/water/floating_body.h"
#include "systems/water/water_dispersion.h"
#include "systems/water/water_query.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace limn {

namespace {

constexpr float kFromHand = 0.6f;  ///< where a stone leaves, along the throw [m]

/// What a ray meets first.
struct Target {
    WaterFrame frame{};
    RippleState* ripples = nullptr;
    WaterPoint point{};
    float distance = 0;  ///< [m]
};

/// A stone without a body: it falls in as fast as if it had flown.
void splash_at(const Target& target, const StoneThrower& thrower) {
    if (target.ripples == nullptr || !(thrower.splash > 0)) {
        return;
    }
    const float mass =
        thrower.density * 4.0f / 3.0f * kPi * thrower.radius * thrower.radius * thrower.radius;
    RippleImpulse impulse = splash_of(mass, thrower.radius, thrower.speed);
    impulse.center = target.point.rest;
    impulse.height *= thrower.splash;
    target.ripples->impulses.push_back(impulse);
}

void create_stone(
    const Target& target, const Vec3& eye, const StoneThrower& thrower, Commands commands) {
    const Vec3 way = target.point.position - eye;
    const float start = std::min(kFromHand, 0.5f * target.distance);
    const Vec3 from = eye + normalize_or(way, Vec3(0, -1, 0)) * start;
    commands.create(
        Transform{.position = from, .scale = Vec3(2 * thrower.radius)},
        MeshInstance{thrower.mesh, thrower.material},
        WaterTouch{.shape = TouchShape::Ball, .half = Vec3(0.5f)},
        Floating{
            .density = thrower.density,
            .splash = thrower.splash,
            .velocity = velocity_to_hit(from, target.point.position, thrower.speed)},
        ThrownStone{thrower.thrown});
}

}  // namespace

void throw_stones(
    Query<StoneThrower> throwers, Query<const ThrownStone> stones,
    Query<
        const Water, const WorldTransform, Optional<const OceanState>, Optional<const WaveTable>,
        Optional<RippleState>>
        waters,
    Res<Input> input, Commands commands) {
    if (!std::as_const(*input).click) {
        return;
    }
    input->click = false;
    const Vec3 along = normalize_or(input->pointing, Vec3(0));
    if (along == Vec3(0)) {
        return;
    }
    throwers.each([&](StoneThrower& thrower) {
        std::optional<Target> target;
        waters.each([&](const Water& water, const WorldTransform& place, const OceanState* ocean,
                        const WaveTable* waves, RippleState* ripples) {
            const WaterSurface surface = {water_frame(place.world), water, ocean, waves, ripples};
            const auto point = hit_water(surface, input->eye, along, thrower.reach);
            const float distance = point ? glm::distance(point->position, input->eye) : 0.0f;
            if (point && (!target || distance < target->distance)) {
                target = Target{surface.frame, ripples, *point, distance};
            }
        });
        if (!target) {
            return;
        }
        ++thrower.thrown;
        if (thrower.mesh == MeshId{}) {
            splash_at(*target, thrower);
            return;
        }
        stones.each([&](Entity entity, const ThrownStone& stone) {
            if (thrower.thrown - stone.number >= thrower.most) {
                commands.destroy(entity);
            }
        });
        if (thrower.most > 0) {
            create_stone(*target, input->eye, thrower, commands);
        }
    });
}

Vec3 velocity_to_hit(const Vec3& from, const Vec3& to, float speed) {
    const float time = std::max(glm::distance(from, to) / std::max(speed, 0.1f), 1e-3f);
    return (to - from) / time + Vec3(0, 0.5f * static_cast<float>(kGravity) * time, 0);
}

}  // namespace limn
