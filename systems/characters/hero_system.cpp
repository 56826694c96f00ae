#include "systems/characters/hero_system.h"

#include "ecs/base/rotation.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limn {
namespace {

constexpr float kThrowAngle = 0.62f;  // of a throw above the view [rad]
constexpr float kFlatThrow = 0.42f;   // likewise above the horizon, without a camera [rad]
constexpr float kLowestThrow = -0.3f;
constexpr float kHighestThrow = 1.2f;
constexpr float kThrowCosine = 0.92f;  // of its facing to the aim, at which it throws
constexpr float kAimTime = 1.5f;       // after which it throws anyway, where it faces [s]
constexpr float kHeaviest = 0.5f;      // of what it lifts, relative to the mass it pushes with
constexpr float kAheadCosine = 0.2f;   // of what it can reach
constexpr float kStillGround = 1e-3f;  // or slower: it does not move [m/s]
constexpr float kStoodTime = 1.0f;     // between two places where it stood [s]

Vec3 level_unit(Vec3 way, const Vec3& fallback) {
    way.y = 0;
    return normalize_or(way, fallback);
}

/// Where a camera looks; +z without one.
Vec3 camera_view(const WorldTransform* camera) {
    return camera != nullptr ? normalize_or(-transform_vector(camera->world, {0, 0, 1}), {0, 0, 1})
                             : Vec3(0, 0, 1);
}

/// Direction in which it throws: above that in which the camera looks, or ahead.
Vec3 throw_direction(const WorldTransform* camera, const Vec3& facing) {
    const Vec3 view = camera_view(camera);
    const float angle =
        camera != nullptr ? std::clamp(
            std::asin(std::clamp(view.y, -1.0f, 1.0f)) + kThrowAngle, kLowestThrow, kHighestThrow)
                          : kFlatThrow;
    const Vec3 level = camera != nullptr ? level_unit(view, facing) : facing;
    return std::cos(angle) * level + Vec3(0, std::sin(angle), 0);
}

/// Turns to the aim, and returns whether it throws now.
bool step_aim(const Vec3& facing, float dt, HeroState& hero, MoveIntent& intent) {
    const Vec3 toward = level_unit(hero.aim, facing);
    intent.facing = toward;
    hero.aiming += dt;
    if (glm::dot(toward, facing) >= kThrowCosine) {
        return true;
    }
    if (hero.aiming < kAimTime) {
        return false;
    }
    hero.aim = glm::length(Vec3(hero.aim.x, 0, hero.aim.z)) * facing + Vec3(0, hero.aim.y, 0);
    return true;
}

/// The loose body to pick up: the nearest in reach, with the cosine of the direction to it from
/// that ahead above `cosine`; null: none.
template <typename Bodies>
Entity find_loose(
    const Bodies& bodies, const Hero& hero, const CharacterMotor& motor, const Transform& transform,
    float cosine) {
    Entity nearest{};
    float least = std::numeric_limits<float>::infinity();
    const Vec3 ahead = transform.rotation * Vec3(0, 0, 1);
    bodies.each(
        [&](Entity entity, const LooseBody& body, const LooseState& state, const Transform& at) {
            Vec3 to = at.position - transform.position;
            const bool in_height = to.y > -body.radius && to.y < motor.height;
            to.y = 0;
            const float distance = glm::length(to) - motor.radius - body.radius;
            const bool is_ahead = glm::dot(normalize_or(to, ahead), ahead) > cosine;
            if (in_height && is_ahead && state.carrier.is_null() && distance <= hero.reach
                && body.mass <= kHeaviest * motor.push && distance < least) {
                least = distance;
                nearest = entity;
            }
        });
    return nearest;
}

}  // namespace

void add_hero_states(Query<const Hero, Without<HeroState>> bare, Commands commands) {
    bare.each([&](Entity entity, const Hero&) { commands.add(entity, HeroState{}); });
}

void update_heroes(
    Query<Hero, HeroState, const CharacterMotor, const MotorState, MoveIntent, const Transform>
        heroes,
    Query<const LooseBody, LooseState, const Transform, Without<CharacterMotor>> bodies,
    Query<const WorldTransform, With<Camera>> cameras, Res<const Input> input,
    Res<const FrameTime> time) {
    heroes.each([&](Entity entity, Hero& hero, HeroState& moves, const CharacterMotor& motor,
                    const MotorState& state, MoveIntent& intent, const Transform& transform) {
        const auto* const camera = cameras.find<const WorldTransform>(hero.camera);
        const Vec3 ahead = level_unit(camera_view(camera), {0, 0, 1});
        const Vec3 facing = level_unit(transform.rotation * Vec3(0, 0, 1), {0, 0, 1});
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
        LooseState* const carried = bodies.find<LooseState>(hero.carried);
        if (carried == nullptr || carried->carrier != entity) {
            if (!hero.carried.is_null()) {
                moves.aim = Vec3(0);  // it was to be thrown, and is gone
            }
            hero.carried = {};
            const bool turned = moves.aim != Vec3(0) && step_aim(facing, time->step, moves, intent);
            if (turned || is_pressed(*input, "hero_carry")) {
                moves.aim = Vec3(0);
                hero.carried = find_loose(bodies, hero, motor, transform, kAheadCosine);
            }
            if (LooseState* const found = bodies.find<LooseState>(hero.carried)) {
                found->carrier = entity;
            } else if (is_pressed(*input, "hero_carry")) {
                // What is beside or behind: turns to it first.
                const auto* const at =
                    bodies.find<const Transform>(find_loose(bodies, hero, motor, transform, -2));
                moves.aim = at != nullptr ? level_unit(at->position - transform.position, Vec3(0))
                                          : Vec3(0);
                moves.aiming = 0;
            }
            return;
        }
        if (moves.aim == Vec3(0) && is_pressed(*input, "hero_carry")) {
            moves.aim = throw_direction(camera, facing);
            moves.aiming = 0;
        }
        if (moves.aim != Vec3(0) && step_aim(facing, time->step, moves, intent)) {
            carried->carrier = {};
            carried->velocity = state.velocity + state.drift + hero.throw_speed * moves.aim;
            hero.carried = {};
            moves.aim = Vec3(0);
        }
    });
}

void return_lost_heroes(
    Query<const Hero, HeroState, MotorState, Transform, Without<Parent>> heroes,
    Res<const FrameTime> time, Commands commands) {
    heroes.each([&](Entity entity, const Hero& hero, HeroState& moves, MotorState& state,
                    Transform& transform) {
        moves.since_stood += time->step;
        if (state.mode == MotorMode::Stand && glm::length(state.drift) < kStillGround
            && (moves.has_stood == 0 || moves.since_stood > kStoodTime)) {
            const Vec3 now = transform.position;
            moves.stood = {moves.has_stood != 0 ? moves.stood[1] : now, now};
            moves.has_stood = 1;
            moves.since_stood = 0;
        }
        const bool falls_on = state.mode == MotorMode::Fall && state.above < 0;
        if (hero.lost > 0 && falls_on && state.air_time > hero.lost && moves.has_stood != 0) {
            transform.position = moves.stood[0];
            moves.stood[1] = moves.stood[0];
            state = {};
            moves.aim = Vec3(0);
            commands.add(entity, Teleport{});
        }
    });
}

}  // namespace limn
