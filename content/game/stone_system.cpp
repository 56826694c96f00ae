#include "content/game/stone_system.h"

#include "ecs/components/buoyancy.h"
#include "systems/water/floating_body.h"
#include "systems/water/water_dispersion.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace limn {

namespace {

constexpr float kFromHand = 0.6f;  ///< start of the flight, along the throw [m]

/// First surface hit by a ray.
struct Target {
    Entity water{};
    WaterPoint point{};
    float distance = 0;  ///< [m]
};

/// A stone without a mesh: an immediate splash with the speed of a flight.
void splash_at(const Target& target, const StoneThrower& thrower, RippleState& ripples) {
    const float mass =
        thrower.density * 4.0f / 3.0f * kPi * thrower.radius * thrower.radius * thrower.radius;
    RippleImpulse impulse = splash_of(mass, thrower.radius, thrower.speed);
    impulse.center = target.point.rest;
    impulse.height *= thrower.splash;
    ripples.impulses.push_back(impulse);
}

void create_stone(
    const Target& target, const Vec3& eye, const StoneThrower& thrower, std::uint32_t number,
    Commands commands) {
    const Vec3 to_target = target.point.position - eye;
    const float start = std::min(kFromHand, 0.5f * target.distance);
    const Vec3 from = eye + normalize_or(to_target, Vec3(0, -1, 0)) * start;
    commands.create(
        Transform{.position = from, .scale = Vec3(2 * thrower.radius)},
        MeshInstance{thrower.mesh, thrower.material},
        WaterTouch{.shape = TouchShape::Ball, .half = Vec3(0.5f)},
        Floating{.density = thrower.density, .splash = thrower.splash},
        FloatingState{.velocity = velocity_to_hit(from, target.point.position, thrower.speed)},
        ThrownStone{number});
}

}  // namespace

void add_stone_throwers(
    Query<const StoneThrower, Without<StoneThrowerState>> throwers, Commands commands) {
    throwers.each(
        [&](Entity entity, const StoneThrower&) { commands.add(entity, StoneThrowerState{}); });
}

void throw_stones(
    Query<const StoneThrower, StoneThrowerState> throwers, Query<const ThrownStone> stones,
    WaterQuery waters, Query<RippleState> ripples, Res<Input> input, Commands commands) {
    if (!std::as_const(*input).click) {
        return;
    }
    input->click = false;
    const Vec3 along = normalize_or(input->pointing, Vec3(0));
    if (along == Vec3(0)) {
        return;
    }
    const std::vector<WaterSurface> surfaces = collect_water_surfaces(waters);
    throwers.each([&](const StoneThrower& thrower, StoneThrowerState& state) {
        std::optional<Target> target;
        for (const WaterSurface& surface : surfaces) {
            const auto point = hit_water(surface, input->eye, along, thrower.reach);
            const float distance = point ? glm::distance(point->position, input->eye) : 0.0f;
            if (point && (!target || distance < target->distance)) {
                target = Target{surface.entity, *point, distance};
            }
        }
        if (!target) {
            return;
        }
        ++state.thrown;
        if (thrower.mesh == MeshId{}) {
            auto* const hit = ripples.find<RippleState>(target->water);
            if (hit != nullptr && thrower.splash > 0) {
                splash_at(*target, thrower, *hit);
            }
            return;
        }
        stones.each([&](Entity entity, const ThrownStone& stone) {
            if (state.thrown - stone.number >= thrower.max_stones) {
                commands.destroy(entity);
            }
        });
        if (thrower.max_stones > 0) {
            create_stone(*target, input->eye, thrower, state.thrown, commands);
        }
    });
}

Vec3 velocity_to_hit(const Vec3& from, const Vec3& to, float speed) {
    const float time = std::max(glm::distance(from, to) / std::max(speed, 0.1f), 1e-3f);
    return (to - from) / time + Vec3(0, 0.5f * static_cast<float>(kGravity) * time, 0);
}

}  // namespace limn
