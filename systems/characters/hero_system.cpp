#include "systems/characters/hero_system.h"

#include "ecs/base/rotation.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>

namespace limn {
namespace {

constexpr float kThrowRise = 0.45f;   // of a throw, relative to its way ahead
constexpr float kHeaviest = 0.5f;     // of what it lifts, relative to the mass it pushes with
constexpr float kAheadCosine = 0.2f;  // of what it can reach

/// Horizontal, unit; +z without one.
Vec3 camera_ahead(const WorldTransform* camera) {
    if (camera == nullptr) {
        return {0, 0, 1};
    }
    Vec3 ahead = -transform_vector(camera->world, {0, 0, 1});
    ahead.y = 0;
    return normalize_or(ahead, {0, 0, 1});
}

/// The loose body to pick up: the nearest ahead of the character; null if none is in reach.
template <typename Bodies>
Entity find_loose(
    const Bodies& bodies, const Hero& hero, const CharacterMotor& motor,
    const Transform& transform) {
    Entity nearest{};
    float least = std::numeric_limits<float>::infinity();
    const Vec3 ahead = transform.rotation * Vec3(0, 0, 1);
    bodies.each(
        [&](Entity entity, const LooseBody& body, const LooseState& state, const Transform& at) {
            Vec3 to = at.position - transform.position;
            const bool in_height = to.y > -body.radius && to.y < motor.height;
            to.y = 0;
            const float distance = glm::length(to) - motor.radius - body.radius;
            const bool is_ahead = glm::dot(normalize_or(to, ahead), ahead) > kAheadCosine;
            if (in_height && is_ahead && state.carrier.is_null() && distance <= hero.reach
                && body.mass <= kHeaviest * motor.push && distance < least) {
                least = distance;
                nearest = entity;
            }
        });
    return nearest;
}

}  // namespace

void update_heroes(
    Query<Hero, const CharacterMotor, const MotorState, MoveIntent, const Transform> heroes,
    Query<const LooseBody, LooseState, const Transform, Without<CharacterMotor>> bodies,
    Query<const WorldTransform, With<Camera>> cameras, Res<const Input> input) {
    heroes.each([&](Entity entity, Hero& hero, const CharacterMotor& motor, const MotorState& state,
                    MoveIntent& intent, const Transform& transform) {
        const Vec3 ahead = camera_ahead(cameras.find<const WorldTransform>(hero.camera));
        const Vec3 right = glm::cross(ahead, Vec3(0, 1, 0));
        Vec3 way = action_axis(*input, "hero_forward", "hero_back") * ahead
                   + action_axis(*input, "hero_right", "hero_left") * right;
        const float length = glm::length(way);
        way /= std::max(length, 1.0f);
        intent.velocity = way * (action_value(*input, "hero_run") > 0 ? hero.run : hero.walk);
        intent.facing = Vec3(0);
        const bool swims = state.mode == MotorMode::Swim;
        if (swims) {
            intent.velocity.y = motor.swim_speed * action_axis(*input, "hero_jump", "hero_dive");
        }
        intent.jump = !swims && (intent.jump || is_pressed(*input, "hero_jump"));
        if (!is_pressed(*input, "hero_carry")) {
            return;
        }
        LooseState* const carried = bodies.find<LooseState>(hero.carried);
        if (carried != nullptr && carried->carrier == entity) {
            carried->carrier = {};
            carried->velocity =
                state.velocity + state.drift
                + hero.throw_speed * glm::normalize(transform.rotation * Vec3(0, kThrowRise, 1));
            hero.carried = {};
            return;
        }
        hero.carried = find_loose(bodies, hero, motor, transform);
        if (LooseState* const found = bodies.find<LooseState>(hero.carried)) {
            found->carrier = entity;
        }
    });
}

}  // namespace limn
