#include "systems/characters/motor_system.h"

#include "ecs/base/gravity.h"
#include "ecs/base/rotation.h"
#include "ecs/components/placement.h"
#include "systems/animation/ik/placements.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr auto kMotorGravity = static_cast<float>(kGravity);
constexpr float kMotorTopSpeed = 50.0f;  // of a fall [m/s]
constexpr float kCoyote = 0.12f;         // how long after leaving an edge it may still jump [s]
constexpr float kSnapShare = 0.9f;       // of a step: how far down it follows the ground
constexpr float kClimbRate = 14.0f;      // at which it follows steps [1/s]
constexpr float kWadeFrom = 0.15f;       // depths relative to the height: slows from here,
constexpr float kSwimFrom = 0.72f;       // swims from here,
constexpr float kStandFrom = 0.66f;      // and stands again from here
constexpr float kFloatDepth = 0.84f;     // of the soles while swimming
constexpr float kBuoyancy = 3.0f;        // rate at which it rises to that depth [1/s]
constexpr float kContactSkin = 1e-4f;    // depth of contacts that is left [m]
constexpr int kMaxParts = 512;           // of a step
constexpr float kThickest = 2.0f;        // wall out of which it finds a way [m]
constexpr int kMaxContacts = 6;          // in a part
constexpr float kLookDown = 4.0f;        // for the ground, while it falls [m]
constexpr float kWallGap = 0.08f;        // within which a wall is felt [m]

Vec3 level_part(const Vec3& v) {
    return {v.x, 0, v.z};
}

Vec3 shortened_to(const Vec3& v, float length) {
    const float size = glm::length(v);
    return size > length ? v * (length / size) : v;
}

/// What stops a motor where it stands, at `feet`.
class Surroundings {
  public:
    Surroundings(const CharacterMotor& motor, std::span<const PlacedGround> grounds)
        : motor_(motor), grounds_(grounds),
          step_(std::clamp(motor.step, 0.0f, 0.5f * motor.height)),
          radius_(std::clamp(motor.radius, 0.01f, 0.5f * (motor.height - step_))),
          walkable_(std::cos(motor.slope)) {}

    [[nodiscard]] std::span<const PlacedGround> grounds() const { return grounds_; }
    [[nodiscard]] float step() const { return step_; }
    [[nodiscard]] float radius() const { return radius_; }
    [[nodiscard]] bool is_walkable(const Vec3& normal) const { return normal.y >= walkable_; }

    /// The part of the capsule above a step.
    [[nodiscard]] Capsule capsule(const Vec3& feet) const {
        return {
            feet + Vec3(0, step_ + radius_, 0), feet + Vec3(0, motor_.height - radius_, 0),
            radius_};
    }

    /// Below the feet, at most `down` [m]: below the middle, or else where most of the rim is.
    [[nodiscard]] Landing land(const Vec3& feet, float down) const {
        Landing best = land_at(feet, down);
        const float rim = 0.7f * radius_;
        for (const Vec3& offset :
             {Vec3(rim, 0, 0), Vec3(-rim, 0, 0), Vec3(0, 0, rim), Vec3(0, 0, -rim)}) {
            const Landing at = land_at(feet + offset, down);
            const bool stands = at.ground != nullptr && is_walkable(at.normal);
            const bool is_better = best.ground == nullptr || !is_walkable(best.normal)
                                   || at.point.y > best.point.y + 1e-4f;
            if (stands && is_better && !is_same_slope(best, at)) {
                best = at;
                best.point.x = feet.x;
                best.point.z = feet.z;
            }
        }
        return best;
    }

    [[nodiscard]] std::optional<GroundContact> touch(const Vec3& feet) const {
        return find_deepest_contact(grounds_, capsule(feet));
    }

  private:
    [[nodiscard]] Landing land_at(const Vec3& feet, float down) const {
        return find_landing(
            grounds_, {feet + Vec3(0, step_ + 0.05f * radius_, 0), feet - Vec3(0, down, 0)});
    }
    /// Whether the rim only touches the slope on which the middle stands.
    [[nodiscard]] static bool is_same_slope(const Landing& middle, const Landing& rim) {
        return middle.ground != nullptr
               && std::abs(glm::dot(rim.point - middle.point, middle.normal)) < 0.01f;
    }

    const CharacterMotor& motor_;
    std::span<const PlacedGround> grounds_;
    float step_;
    float radius_;
    float walkable_;
};

Quat rotation_of(const PlacedGround& ground) {
    return decompose_affine(ground.world).rotation;
}

/// What it was attached to carries it for one more step.
void let_go(float dt, MotorBody& body) {
    body.transform.position += dt * body.state.drift;
    body.state.ride.to = body.transform.position;
    body.state.held = 0;
}

/// Carries the character with the ground on which it stands.
void ride(std::span<const PlacedGround> grounds, float dt, MotorBody& body) {
    MotorState& state = body.state;
    Transform& at = body.transform;
    state.ride = {.from = at.position, .to = at.position};
    if (state.held != 0) {
        let_go(dt, body);
        return;
    }
    if (state.mode != MotorMode::Stand) {
        return;
    }
    const bool has_arrived = state.arrived != 0;
    state.velocity += has_arrived ? level_part(state.drift) : Vec3(0);
    state.arrived = 0;
    state.drift = Vec3(0);
    const PlacedGround* const ground = find_placed(grounds, state.ground);
    if (ground == nullptr) {
        return;
    }
    const Vec3 carried = transform_point(ground->world, state.point);
    const Quat rotation = rotation_of(*ground);
    if (!is_finite(carried)) {
        return;
    }
    const Quat turn = normalize_or_identity(rotation * glm::conjugate(state.ground_rotation));
    // One that something else has moved since then goes on from there.
    at.position = carried + turn * (at.position - state.place);
    state.ride.to = at.position;
    state.drift = dt > 0 ? (at.position - state.ride.from) / dt : Vec3(0);
    state.velocity -= has_arrived ? level_part(state.drift) : Vec3(0);
    if (rotation != state.ground_rotation) {
        state.ride.turn = turn;
        const Vec3 now = level_part(at.rotation * Vec3(0, 0, 1));
        const Vec3 ahead = level_part(state.ride.turn * now);
        state.ride.yaw =
            std::remainder(std::atan2(ahead.x, ahead.z) - std::atan2(now.x, now.z), 2 * kPi);
        at.rotation =
            normalize_or_identity(rotation_about({0, 1, 0}, state.ride.yaw) * at.rotation);
    }
}

/// It keeps the velocity of the ground that it leaves.
void leave_ground(MotorState& state) {
    state.velocity.y += state.drift.y;
    state.drift.y = 0;
    state.arrived = 0;
    state.mode = MotorMode::Fall;
}

/// Its velocity is that in the world from now on.
void forget_drift(MotorState& state) {
    state.velocity += level_part(state.drift);
    state.drift = Vec3(0);
}

void remember_ground(const Landing& landing, MotorBody& body) {
    body.state.ground = landing.ground->entity;
    body.state.point = transform_point(landing.ground->local, body.transform.position);
    body.state.ground_rotation = rotation_of(*landing.ground);
    body.state.normal = landing.normal;
}

/// Stands upright, and turns toward where it wants to face.
void turn_body(const CharacterMotor& motor, const MoveIntent& intent, float dt, Quat& rotation) {
    const Vec3 now = level_part(rotation * Vec3(0, 0, 1));
    const float yaw = now != Vec3(0) ? std::atan2(now.x, now.z) : 0.0f;
    const Vec3 facing = level_part(is_finite(intent.facing) ? intent.facing : Vec3(0));
    const Vec3 moving = level_part(is_finite(intent.velocity) ? intent.velocity : Vec3(0));
    const bool faces = glm::length(facing) > 1e-3f;
    const Vec3 wanted = faces ? facing : moving;
    float turn = 0;
    if (faces || glm::length(moving) > 0.05f) {
        const float limit = motor.turn * dt;
        turn = std::clamp(
            std::remainder(std::atan2(wanted.x, wanted.z) - yaw, 2 * kPi), -limit, limit);
    }
    rotation = rotation_about({0, 1, 0}, yaw + turn);
}

/// The water about the feet.
struct Wetness {
    float depth = -1;
    Vec3 velocity = Vec3(0);
};

Wetness find_wetness(std::span<const WaterSurface> waters, const Vec3& feet) {
    const auto around = find_water(waters, feet + Vec3(0, 0.02f, 0));
    return around ? Wetness{around->depth + 0.02f, around->surface.velocity} : Wetness{};
}

void choose_mode(const CharacterMotor& motor, MotorState& state) {
    const float swim = state.mode == MotorMode::Swim ? kStandFrom : kSwimFrom;
    if (state.depth > swim * motor.height) {
        forget_drift(state);
        state.mode = MotorMode::Swim;
    } else if (state.mode == MotorMode::Swim) {
        state.mode = MotorMode::Fall;
    }
}

void accelerate(
    const CharacterMotor& motor, const MoveIntent& intent, const Wetness& water, float dt,
    MotorBody& body) {
    MotorState& state = body.state;
    const Vec3 intended = is_finite(intent.velocity) ? intent.velocity : Vec3(0);
    Vec3 wanted = level_part(shortened_to(intended, kMotorTopSpeed));
    if (state.mode == MotorMode::Swim) {
        wanted = shortened_to(wanted, motor.swim_speed) + level_part(water.velocity);
        const float rise = kBuoyancy * (state.depth - kFloatDepth * motor.height);
        const float vertical = std::abs(intended.y) > 0.05f
                                   ? std::clamp(intended.y, -motor.swim_speed, motor.swim_speed)
                                   : std::clamp(rise, -motor.swim_speed, motor.swim_speed);
        wanted.y = std::min(vertical, std::max(rise, 0.0f)) + water.velocity.y;
        state.velocity += shortened_to(wanted - state.velocity, 2 * motor.air_acceleration * dt);
        return;
    }
    const float wade =
        std::clamp((state.depth / motor.height - kWadeFrom) / (kSwimFrom - kWadeFrom), 0.0f, 1.0f);
    wanted *= 1 - 0.65f * wade;
    const bool stands = state.mode == MotorMode::Stand;
    const float rate = stands ? motor.acceleration : motor.air_acceleration;
    if (stands || wanted != Vec3(0)) {
        state.velocity += shortened_to(wanted - level_part(state.velocity), rate * dt);
    }
    const bool can_jump = intent.jump && (stands || state.air_time < kCoyote) && motor.jump > 0;
    state.gather = can_jump && stands ? state.gather + dt : 0.0f;
    if (can_jump && (!stands || state.gather > motor.take_off)) {
        state.gather = 0;
        // Speeds change before positions, which half a step of gravity makes up for.
        state.velocity.y = std::sqrt(2 * kMotorGravity * motor.jump) - 0.5f * kMotorGravity * dt;
        leave_ground(state);
        state.air_time = kCoyote;
        body.jumped = true;
    } else if (stands) {
        state.velocity.y = 0;
    } else {
        state.velocity.y -= kMotorGravity * dt;
    }
    state.velocity = shortened_to(state.velocity, kMotorTopSpeed);
}

/// What a ground belongs to: one that moves as a whole.
Entity base_of(std::span<const PlacedGround> grounds, Entity entity) {
    const PlacedGround* const ground = find_placed(grounds, entity);
    return ground != nullptr ? ground->base : Entity{};
}

/// Pushes it out of walls and ceilings, and takes away the speed into them. `drift`: in addition to
/// its own velocity; shared by what belongs to the ground that it has left.
void leave_solids(const Surroundings& around, const Vec3& drift, MotorBody& body) {
    for (int i = 0; i < kMaxContacts; ++i) {
        const std::optional<GroundContact> touch = around.touch(body.transform.position);
        if (!touch || touch->contact.depth < kContactSkin) {
            return;
        }
        Vec3 normal = touch->contact.normal;
        float depth = touch->contact.depth;
        // One that stands is pushed aside by walls, and not up or down.
        const float side = glm::length(level_part(normal));
        if (body.state.mode == MotorMode::Stand && side > 0.2f) {
            normal = level_part(normal) / side;
            depth /= side;
        }
        body.transform.position += std::min(depth, around.radius()) * normal;
        const bool drifts_along = base_of(around.grounds(), touch->ground)
                                  == base_of(around.grounds(), body.state.ground);
        const Vec3 motion = body.state.velocity + (drifts_along ? Vec3(0) : drift);
        body.state.velocity -= std::min(glm::dot(motion, normal), 0.0f) * normal;
        if (side > 0.7f) {
            body.state.wall = level_part(normal) / glm::length(level_part(normal));
        }
    }
}

/// Forgets a wall that is no longer there, or toward which it does not want to go.
void feel_wall(const Surroundings& around, const MoveIntent& intent, MotorBody& body) {
    Vec3& wall = body.state.wall;
    const Vec3 wanted = level_part(is_finite(intent.velocity) ? intent.velocity : Vec3(0));
    if (wall != Vec3(0)
        && (glm::dot(wanted, wall) > -1e-3f
            || !around.touch(body.transform.position - kWallGap * wall))) {
        wall = Vec3(0);
    }
}

void look_down(std::span<const PlacedGround> grounds, MotorBody& body) {
    const Vec3& feet = body.transform.position;
    const Landing below = body.state.mode == MotorMode::Fall
                              ? find_landing(grounds, {feet, feet - Vec3(0, kLookDown, 0)})
                              : Landing{};
    body.state.above = below.ground != nullptr ? feet.y - below.point.y : -1.0f;
}

/// One that was put into a wall comes out on the nearest side.
void leave_inside(
    const CharacterMotor& motor, const Surroundings& around, std::span<const PlacedGround> grounds,
    MotorBody& body) {
    const Vec3 middle = body.transform.position + Vec3(0, 0.5f * motor.height, 0);
    const Vec3 out = find_way_out(grounds, middle, kThickest);
    if (out != Vec3(0)) {
        body.transform.position += out + around.radius() * normalize_or(out, Vec3(0));
    }
}

/// Puts it on the ground below, if it is to stand on it. `dt`: of this part of the step.
void meet_ground(const Surroundings& around, float dt, MotorBody& body) {
    MotorState& state = body.state;
    Vec3& feet = body.transform.position;
    const bool stood = state.mode == MotorMode::Stand;
    const Landing landing = around.land(feet, stood ? kSnapShare * around.step() + 0.02f : 0.0f);
    const bool rises = state.velocity.y > 1e-3f && !stood;
    if (stood && (landing.ground == nullptr || !around.is_walkable(landing.normal))) {
        leave_ground(state);
    }
    if (landing.ground == nullptr || rises) {
        return;
    }
    if (!around.is_walkable(landing.normal)) {  // too steep: slides
        state.mode = MotorMode::Fall;
        const float below = landing.point.y - feet.y;
        if (below > 0) {
            feet += below * landing.normal.y * landing.normal;
            state.velocity -=
                std::min(glm::dot(state.velocity, landing.normal), 0.0f) * landing.normal;
        }
        return;
    }
    if (state.mode == MotorMode::Swim) {
        if (feet.y < landing.point.y) {
            feet.y = landing.point.y;
            state.velocity.y = std::max(state.velocity.y, 0.0f);
        }
        return;
    }
    const float gap = landing.point.y - feet.y;
    const bool falls_deeper = !stood && gap < 0;
    if (falls_deeper) {
        return;
    }
    // Steps are eased; slopes and landings are followed at once.
    const bool is_step = stood && std::abs(gap) > 0.02f;
    const float ease = is_step ? 1 - std::exp(-kClimbRate * dt) : 1.0f;
    const float slope_gap = glm::length(level_part(state.velocity)) * dt
                            * std::sqrt(std::max(1 - square(landing.normal.y), 0.0f))
                            / std::max(landing.normal.y, 0.1f);
    feet.y += std::abs(gap) <= slope_gap * 1.5f ? gap : ease * gap;
    const bool is_new = landing.ground->base != base_of(around.grounds(), state.ground);
    if (is_new && (!state.ground.is_null() || state.air_time > kCoyote)) {
        state.arrived = 1;
    }
    state.velocity.y = 0;
    state.mode = MotorMode::Stand;
    state.air_time = 0;
    remember_ground(landing, body);
}

bool is_valid(const CharacterMotor& motor, const MotorBody& body) {
    const float sum = motor.radius + motor.height + motor.step + motor.slope + motor.acceleration
                      + motor.air_acceleration + motor.jump + motor.turn + motor.swim_speed;
    return std::isfinite(sum) && motor.height > 0 && is_finite(body.transform.position)
           && is_finite(body.state.velocity);
}

}  // namespace

MotorBody step_motor(
    const CharacterMotor& motor, const MoveIntent& intent, const MotorBody& body,
    std::span<const PlacedGround> grounds, std::span<const WaterSurface> waters, float dt,
    const std::optional<MotorDrive>& drive) {
    MotorBody next = body;
    next.state.ride = {};
    if (!is_valid(motor, body) || !(dt >= 0)) {
        return next;
    }
    next.jumped = false;
    const Surroundings around(motor, grounds);
    ride(grounds, dt, next);
    leave_inside(motor, around, grounds, next);
    const Wetness water = find_wetness(waters, next.transform.position);
    next.state.depth = water.depth;
    next.state.air_time += dt;
    choose_mode(motor, next.state);
    // In the step in which it leaves the ground, that has carried it already.
    const bool stood = next.state.mode == MotorMode::Stand;
    const float rise = dt * next.state.drift.y;
    const Vec3 drift = next.state.mode == MotorMode::Fall ? level_part(next.state.drift) : Vec3(0);
    const bool is_driven = drive && is_finite(drive->velocity) && std::isfinite(drive->turn)
                           && next.state.mode == MotorMode::Stand;
    if (is_driven) {
        next.transform.rotation = normalize_or_identity(
            rotation_about({0, 1, 0}, drive->turn * dt) * next.transform.rotation);
    } else {
        turn_body(motor, intent, dt, next.transform.rotation);
    }
    accelerate(motor, intent, water, dt, next);
    if (stood && next.state.mode == MotorMode::Fall) {
        next.transform.position.y -= rise;  // is part of its velocity now
    }
    if (is_driven && next.state.mode == MotorMode::Stand) {
        next.state.velocity = shortened_to(level_part(drive->velocity), kMotorTopSpeed);
    }
    const float way = glm::length(next.state.velocity + drift) * dt;
    const int parts =
        std::clamp(static_cast<int>(std::ceil(2 * way / around.radius())), 1, kMaxParts);
    const float part = dt / static_cast<float>(parts);
    for (int i = 0; i < parts; ++i) {
        next.transform.position += part * (next.state.velocity + drift);
        leave_solids(around, drift, next);
        meet_ground(around, part, next);
    }
    feel_wall(around, intent, next);
    look_down(grounds, next);
    next.state.place = next.transform.position;
    return next;
}

void add_motor_states(
    Query<const CharacterMotor, Without<MotorState>> bare,
    Query<const CharacterMotor, Without<MoveIntent>> aimless,
    Query<const CharacterMotor, const Transform, With<Parent>, Without<MotorState>, Without<Attach>>
        children,
    Query<MotorState, With<CharacterMotor>, With<Parent>> held,
    Query<const MotorState, Without<CharacterMotor>> left, Query<const Transform> transforms,
    Query<const Parent> parents, OptionalRes<const FrameTime> time, Commands commands) {
    const Placements placements(transforms, parents);
    children.each([&](Entity entity, const CharacterMotor&, const Transform&) {
        commands.set(entity, decompose_affine(placements.world(entity)));
        commands.remove<Parent>(entity);
    });
    const float step = time ? time->step : 0.0f;
    held.each([&](Entity entity, MotorState& state) {
        const Vec3 place = transform_point(placements.world(entity), Vec3(0));
        const bool was_held = state.held != 0 && step > 0;
        state = {
            .drift =
                was_held ? shortened_to((place - state.place) / step, kMotorTopSpeed) : Vec3(0),
            .place = place,
            .held = 1,
            .air_time = was_held ? state.air_time + step : 0.0f,
            .mode = MotorMode::Stand};
    });
    left.each([&](Entity entity, const MotorState&) { commands.remove<MotorState>(entity); });
    bare.each([&](Entity entity, const CharacterMotor&) { commands.add(entity, MotorState{}); });
    aimless.each([&](Entity entity, const CharacterMotor&) { commands.add(entity, MoveIntent{}); });
}

void update_motors(
    Query<
        const CharacterMotor, Optional<const MotionMatchState>, MoveIntent, MotorState, Transform,
        Without<Parent>>
        motors,
    GroundQueries grounds, WaterQuery waters, Res<const FrameTime> time) {
    if (motors.empty()) {
        return;
    }
    const std::vector<PlacedGround> placed = place_grounds(grounds);
    const std::vector<WaterSurface> surfaces = collect_water_surfaces(waters);
    motors.each([&](const CharacterMotor& motor, const MotionMatchState* match, MoveIntent& intent,
                    MotorState& state, Transform& transform) {
        std::optional<MotorDrive> drive;
        if (match != nullptr && match->started != 0 && match->away == 0) {
            const Vec3 velocity = transform.rotation * Vec3(match->drive.x, 0, match->drive.y);
            drive = {velocity, match->drive_turn};
        }
        const MotorBody body = step_motor(
            motor, intent, {transform, state, false}, placed, surfaces, time->step, drive);
        transform = body.transform;
        state = body.state;
        intent.jump = intent.jump && !body.jumped;
    });
}

}  // namespace limn
