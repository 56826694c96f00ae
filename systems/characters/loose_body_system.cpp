#include "systems/characters/loose_body_system.h"

#include "ecs/base/gravity.h"
#include "ecs/base/rotation.h"
#include "systems/characters/ground_ride.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr auto kFallAcceleration = static_cast<float>(kGravity);  // [m/s^2]
constexpr float kLooseTopSpeed = 60.0f;                           // [m/s]
constexpr float kLooseRestSpeed = 0.3f;  // towards a surface, below which nothing bounces [m/s]
constexpr float kRollingShare = 0.03f;   // of the friction, while it rolls
constexpr float kLooseWaterDrag = 2.0f;  // [1/s]
constexpr int kMaxLooseParts = 64;
constexpr float kGraspTime = 0.18f;  // until hands are at what they pick up [s]
constexpr float kLiftTime = 0.35f;   // in which they lift it then [s]
constexpr float kLiftRate = 16.0f;   // at which it follows them in the end [1/s]
constexpr float kHoldHeight = 0.6f;  // of what is carried, relative to the height of the carrier

struct SolidContact {
    Vec3 normal = Vec3(0, 1, 0);
    float depth = 0;
};

/// The deepest contact of a ball: with meshes, or with what lies below its center.
std::optional<SolidContact>
touch_solids(std::span<const PlacedGround> grounds, const Vec3& center, float radius) {
    std::optional<SolidContact> deepest;
    if (const auto mesh = find_deepest_contact(grounds, {center, center, radius})) {
        deepest = SolidContact{mesh->contact.normal, mesh->contact.depth};
    }
    const Landing below = find_landing(grounds, {center, center - Vec3(0, radius, 0)});
    if (below.ground != nullptr) {
        const float depth = radius - glm::dot(center - below.point, below.normal);
        if (!deepest || depth > deepest->depth) {
            deepest = SolidContact{below.normal, depth};
        }
    }
    return deepest;
}

void leave_solid(const LooseBody& body, const SolidContact& contact, float dt, LooseStep& next) {
    next.position += contact.depth * contact.normal;
    const float toward = -glm::dot(next.velocity, contact.normal);
    if (toward <= 0) {
        return;
    }
    const float bounce = toward > kLooseRestSpeed ? std::clamp(body.bounce, 0.0f, 1.0f) : 0.0f;
    next.velocity += (1 + bounce) * toward * contact.normal;
    // Coulomb's friction of the impulse, at least that of the weight; rolling has little of it.
    const float share = body.rolls ? kRollingShare : 1.0f;
    const float loss = std::max(body.friction, 0.0f) * share
                       * std::max((1 + bounce) * toward, kFallAcceleration * dt * contact.normal.y);
    const Vec3 along = next.velocity - glm::dot(next.velocity, contact.normal) * contact.normal;
    const float speed = glm::length(along);
    if (speed > 0) {
        next.velocity -= along * std::min(loss / speed, 1.0f);
    }
    if (body.rolls && speed > 0) {
        const Vec3 axis = glm::cross(contact.normal, along);
        next.rotation = normalize_or_identity(
            rotation_about(axis, speed * dt / std::max(body.radius, 1e-3f)) * next.rotation);
    }
}

void float_in_water(
    const LooseBody& body, std::span<const WaterSurface> waters, float dt, LooseStep& next) {
    const Vec3 lowest = next.position - Vec3(0, body.radius, 0);
    const auto around = find_water(waters, lowest);
    if (!around) {
        return;
    }
    const float sunk = std::clamp(around->depth / (2 * body.radius), 0.0f, 1.0f);
    next.velocity.y += 2 * kFallAcceleration * sunk * dt;  // half as dense as water
    next.velocity +=
        (around->surface.velocity - next.velocity) * (1 - std::exp(-kLooseWaterDrag * sunk * dt));
}

/// A body and its row, in world order.
struct LooseRow {
    Entity entity{};
    const LooseBody* body = nullptr;
    LooseState* state = nullptr;
    Transform* transform = nullptr;
};

/// Pushes a ball out of a character, and gives both the speed of an inelastic hit.
void meet_character(
    const CharacterMotor& motor, const MotorState& state, const Vec3& feet, LooseRow& row) {
    const float radius = std::min(motor.radius, 0.5f * motor.height);
    const Vec3 low = feet + Vec3(0, radius, 0);
    const Vec3 high = feet + Vec3(0, std::max(motor.height - radius, radius), 0);
    Vec3& center = row.transform->position;
    const NearestPoints nearest = nearest_of_segments(low, high, center, center);
    const float depth = radius + row.body->radius - nearest.distance;
    if (!(depth > 0)) {
        return;
    }
    const Vec3 normal = normalize_or(center - nearest.a, Vec3(0, 0, 1));
    center += depth * normal;
    const float toward = glm::dot(state.velocity + state.drift - row.state->velocity, normal);
    if (toward > 0) {
        const float share = motor.push / std::max(motor.push + row.body->mass, 1e-6f);
        row.state->velocity += share * toward * normal;
    }
}

void separate(LooseRow& a, LooseRow& b) {
    const Vec3 between = b.transform->position - a.transform->position;
    const float depth = a.body->radius + b.body->radius - glm::length(between);
    if (!(depth > 0)) {
        return;
    }
    const Vec3 normal = normalize_or(between, Vec3(1, 0, 0));
    const float mass = a.body->mass + b.body->mass;
    const float share = b.body->mass / mass;  // how far a gives way
    a.transform->position -= share * depth * normal;
    b.transform->position += (1 - share) * depth * normal;
    const float toward = glm::dot(a.state->velocity - b.state->velocity, normal);
    if (toward > 0) {
        const float bounce = std::min(a.body->bounce, b.body->bounce);
        const Vec3 impulse = (1 + bounce) * toward * a.body->mass * share * normal;
        a.state->velocity -= impulse / a.body->mass;
        b.state->velocity += impulse / b.body->mass;
    }
}

}  // namespace

LooseStep step_loose_body(
    const LooseBody& body, const LooseStep& last, std::span<const PlacedGround> grounds,
    std::span<const WaterSurface> waters, float dt) {
    if (!is_finite(last.position) || !is_finite(last.velocity) || !(dt >= 0)
        || !(body.radius > 0)) {
        return last;
    }
    LooseStep next = last;
    next.velocity.y -= kFallAcceleration * dt;
    float_in_water(body, waters, dt, next);
    const float speed = glm::length(next.velocity);
    next.velocity *= speed > kLooseTopSpeed ? kLooseTopSpeed / speed : 1.0f;
    const float way = std::min(speed, kLooseTopSpeed) * dt;
    const int parts =
        std::clamp(static_cast<int>(std::ceil(2 * way / body.radius)), 1, kMaxLooseParts);
    const float part = dt / static_cast<float>(parts);
    for (int i = 0; i < parts; ++i) {
        next.position += part * next.velocity;
        for (int contact = 0; contact < 3; ++contact) {
            const auto touch = touch_solids(grounds, next.position, body.radius);
            if (!touch || !(touch->depth > 0)) {
                break;
            }
            leave_solid(body, *touch, part, next);
        }
    }
    return next;
}

void add_loose_states(Query<const LooseBody, Without<LooseState>> bare, Commands commands) {
    bare.each([&](Entity entity, const LooseBody&) { commands.add(entity, LooseState{}); });
}

void update_loose_bodies(
    Query<const LooseBody, LooseState, Transform, Without<Parent>> bodies,
    Query<const CharacterMotor, const MotorState, Optional<const Hero>> motors,
    GroundQueries grounds, WaterQuery waters, Res<const FrameTime> time) {
    if (bodies.empty()) {
        return;
    }
    const Placements placements(grounds.transforms, grounds.parents);
    const std::vector<PlacedGround> placed = place_grounds(grounds);
    const std::vector<WaterSurface> surfaces = collect_water_surfaces(waters);
    std::vector<LooseRow> free;
    bodies.each([&](Entity entity, const LooseBody& body, LooseState& state, Transform& transform) {
        if (const auto* motor = motors.find<const CharacterMotor>(state.carrier)) {
            const Affine carrier = placements.world(state.carrier);
            const float ahead = motor->radius + body.radius + 0.05f;
            const Vec3 place =
                transform_point(carrier, Vec3(0, kHoldHeight * motor->height, ahead));
            const auto* const holder = motors.find<const MotorState>(state.carrier);
            state.velocity = holder->velocity + holder->drift;
            state.held += time->step;
            const float lift = std::clamp((state.held - kGraspTime) / kLiftTime, 0.0f, 1.0f);
            const float share = 1 - std::exp(-kLiftRate * square(lift) * time->step);
            const bool stands = holder->mode == MotorMode::Stand;
            const Vec3 moves = stands ? holder->velocity : state.velocity;
            const Vec3 carried =
                carry_point(holder->ride, transform.position) + time->step * lift * moves;
            transform.position = glm::mix(carried, place, share);
            return;
        }
        state.carrier = {};
        state.held = 0;
        const LooseStep next = step_loose_body(
            body, {transform.position, state.velocity, transform.rotation}, placed, surfaces,
            time->step);
        transform.position = next.position;
        transform.rotation = next.rotation;
        state.velocity = next.velocity;
        free.push_back({entity, &body, &state, &transform});
    });
    for (std::size_t i = 0; i < free.size(); ++i) {
        for (std::size_t k = i + 1; k < free.size(); ++k) {
            separate(free[i], free[k]);
        }
        motors.each(
            [&](Entity entity, const CharacterMotor& motor, const MotorState& state, const Hero*) {
                const Affine world = placements.world(entity);
                meet_character(motor, state, transform_point(world, Vec3(0)), free[i]);
            });
    }
}

}  // namespace limn
