#include "content/game/walker_system.h"

#include "ecs/base/rotation.h"
#include "systems/water/water_dispersion.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace limn {
namespace {

constexpr float kLookRate = 0.003f;     // [rad/pixel]; all by eye
constexpr float kMaxPitch = 1.45f;      // [rad]
constexpr float kEase = 0.12f;          // time constant of the speed [s]
constexpr float kFastFactor = 2.0f;     // while running
constexpr float kWading = 0.35f;        // fraction of the speed in deep water
constexpr float kDeep = 1.2f;           // depth of full slow-down [m]
constexpr float kAfloat = 0.25f;        // depth of the eyes at which it starts to swim [m]
constexpr float kEyesAbove = 0.14f;     // height of the eyes above the water while swimming [m]
constexpr float kDiveSpeed = 1.2f;      // [m/s]
constexpr float kSink = 1.0f;           // largest speed of a fall in water [m/s]
constexpr float kMaxFallSpeed = 30.0f;  // in air [m/s]
constexpr float kMinHeight = -1e3f;     // where a fall ends [m]
constexpr float kDuck = 3.0f;           // rate of ducking [1/s]
constexpr float kDucked = 0.55f;        // lowering of the eyes when ducked, relative to eye height
constexpr float kSnap = 0.12f;          // extra drop to the next step without a fall [m]
constexpr float kClimb = 8.0f;          // rate of stepping up [1/s]

/// The highest top below a cylinder about `feet` that it can step on; -infinity: none.
float ground_under(std::span<const Ground> grounds, const Vec3& feet, float radius, float step) {
    float highest = -std::numeric_limits<float>::infinity();
    for (const Ground& ground : grounds) {
        const Vec3 local = transform_point(ground.local_from_world, feet);
        const float top = feet.y + (ground.half.y - local.y);
        if (std::abs(local.x) <= ground.half.x + radius
            && std::abs(local.z) <= ground.half.z + radius && top <= feet.y + step) {
            highest = std::max(highest, top);
        }
    }
    return highest;
}

/// Pushes the walker out of boxes that are too high to step on.
void leave_walls(
    std::span<const Ground> grounds, const Walker& walker, float step, Vec3& feet, Vec3& velocity) {
    for (const Ground& ground : grounds) {
        const Vec3 local = transform_point(ground.local_from_world, feet);
        const Vec3 past = {
            ground.half.x + walker.radius - std::abs(local.x), 0,
            ground.half.z + walker.radius - std::abs(local.z)};
        const bool beside = local.y + step < ground.half.y && local.y + walker.eye > -ground.half.y;
        if (past.x <= 0 || past.z <= 0 || !beside) {
            continue;
        }
        Vec3 push(0);
        if (past.x < past.z) {
            push.x = std::copysign(past.x, local.x);
        } else {
            push.z = std::copysign(past.z, local.z);
        }
        // The transpose is the inverse rotation: footings are upright with unit scale.
        const Vec4* row = ground.local_from_world.row;
        const Vec3 out = push.x * Vec3(row[0]) + push.z * Vec3(row[2]);
        feet += out;
        const Vec3 normal = normalize_or(out, Vec3(0));
        velocity -= std::min(glm::dot(velocity, normal), 0.0f) * normal;
    }
}

/// Height of the surface above the feet; negative if there is no water.
float depth_at(std::span<const WaterSurface> waters, const Vec3& feet) {
    const auto around = find_water(waters, feet + Vec3(0, 0.02f, 0));
    return around ? around->depth + 0.02f : -1.0f;
}

}  // namespace

Ground make_ground(const Footing& footing, const Affine& world) {
    // Heading and position; scale is moved into the half extents.
    const Vec3 x = {world.row[0].x, world.row[1].x, world.row[2].x};
    const Vec3 y = {world.row[0].y, world.row[1].y, world.row[2].y};
    const Vec3 z = {world.row[0].z, world.row[1].z, world.row[2].z};
    const Vec3 along = normalize_or(Vec3(x.x, 0, x.z), Vec3(1, 0, 0));
    const Vec3 across = glm::cross(along, Vec3(0, 1, 0));
    const Vec3 center = transform_point(world, footing.offset);
    Ground ground;
    ground.half = glm::abs(footing.half) * Vec3(glm::length(x), glm::length(y), glm::length(z));
    ground.local_from_world.row[0] = Vec4(along, -glm::dot(along, center));
    ground.local_from_world.row[1] = Vec4(0, 1, 0, -center.y);
    ground.local_from_world.row[2] = Vec4(across, -glm::dot(across, center));
    return ground;
}

void step_walker(
    std::span<const Ground> grounds, std::span<const WaterSurface> waters, const MoveInput& input,
    float step, const Walker& settings, WalkerState& walker, Vec3& position) {
    if (!is_finite(position) || !is_finite(walker.velocity) || !(step > 0)) {
        return;
    }
    if (std::isfinite(input.look.x + input.look.y)) {
        walker.yaw = std::remainder(walker.yaw - input.look.x * kLookRate, 2 * kPi);
        walker.pitch = std::clamp(walker.pitch - input.look.y * kLookRate, -kMaxPitch, kMaxPitch);
    }
    walker.depth = depth_at(waters, position);
    const float wet = std::clamp(walker.depth / kDeep, 0.0f, 1.0f);

    const Vec3 move = is_finite(input.move) ? glm::clamp(input.move, Vec3(-1), Vec3(1)) : Vec3(0);
    const Vec3 ahead = {-std::sin(walker.yaw), 0, -std::cos(walker.yaw)};
    const Vec3 right = {-ahead.z, 0, ahead.x};
    Vec3 wanted = move.z * ahead + move.x * right;
    wanted /= std::max(glm::length(wanted), 1.0f);
    wanted *= settings.speed * (input.fast ? kFastFactor : 1.0f) * glm::mix(1.0f, kWading, wet);
    const float blend = 1 - std::exp(-step / kEase);
    Vec3& velocity = walker.velocity;
    velocity.x += (wanted.x - velocity.x) * blend;
    velocity.z += (wanted.z - velocity.z) * blend;

    // Hysteresis: a swimmer stands again only in shallower water.
    const bool swims = walker.depth > settings.eye + (walker.grounded ? kAfloat : -2 * kEyesAbove);
    const bool ducks = walker.depth > 0.5f * settings.eye && move.y < 0;
    walker.duck += ((ducks ? 1.0f : 0.0f) - walker.duck) * (1 - std::exp(-kDuck * step));
    const bool dives = walker.depth > 0.5f * settings.eye && move.y != 0;
    if (dives) {
        velocity.y += (kDiveSpeed * move.y - velocity.y) * blend;
        // Swimming does not lift it out of the water.
        const float rises = (walker.depth - settings.eye + kEyesAbove) / step;
        velocity.y = std::min(velocity.y, std::max(rises, 0.0f));
    } else if (swims) {
        const float rises = walker.depth - settings.eye + kEyesAbove;
        velocity.y += (std::clamp(2 * rises, -kDiveSpeed, kDiveSpeed) - velocity.y) * blend;
    } else {
        velocity.y -= static_cast<float>(kGravity) * step;
        velocity.y = std::max(velocity.y, -glm::mix(kMaxFallSpeed, kSink, wet));
    }

    position += step * velocity;
    leave_walls(grounds, settings, settings.step, position, velocity);
    const float ground = ground_under(grounds, position, 0.5f * settings.radius, settings.step);
    const float above = position.y - ground;
    walker.grounded =
        !dives && above <= (walker.grounded && velocity.y <= 0 ? kSnap + settings.step : 0);
    if (above < 0) {  // stepping up is smoothed; landing is immediate
        const float lift =
            std::max(-above * (1 - std::exp(-kClimb * step)), -above - settings.step);
        position.y += velocity.y < -2 ? -above : std::max(lift, -step * velocity.y);
        velocity.y = std::max(velocity.y, 0.0f);
    } else if (walker.grounded) {
        position.y -= above * (1 - std::exp(-kClimb * step));
        velocity.y = 0;
    }
    position.y = std::max(position.y, kMinHeight);
}

void add_walker_states(Query<const Walker, Without<WalkerState>> walkers, Commands commands) {
    walkers.each([&](Entity entity, const Walker& walker) {
        commands.add(entity, WalkerState{.yaw = walker.yaw});
    });
}

void update_walkers(
    Query<const Walker, WalkerState, Transform, Without<Parent>> walkers,
    Query<const Footing, const WorldTransform> footings, WaterQuery waters,
    Query<const Camera> cameras, Query<Transform> transforms, Res<const Input> input,
    Res<const FrameTime> time) {
    if (walkers.empty()) {
        return;
    }
    std::vector<Ground> grounds;
    footings.each([&](const Footing& footing, const WorldTransform& transform) {
        grounds.push_back(make_ground(footing, transform.world));
    });
    const std::vector<WaterSurface> surfaces = collect_water_surfaces(waters);
    const MoveInput control = {
        {action_axis(*input, "walk_right", "walk_left"), action_axis(*input, "rise", "dive"),
         action_axis(*input, "walk_forward", "walk_back")},
        input->look,
        0,
        action_value(*input, "run") > 0};
    struct Eyes {
        Entity camera;
        Vec3 position;
        float pitch;
    };
    std::vector<Eyes> eyes;
    walkers.each([&](const Walker& settings, WalkerState& walker, Transform& transform) {
        const auto* camera = cameras.find<const Camera>(settings.camera);
        const bool listens = camera == nullptr || camera->active;
        step_walker(
            grounds, surfaces, listens ? control : MoveInput{}, time->step, settings, walker,
            transform.position);
        transform.rotation = rotation_about({0, 1, 0}, walker.yaw);
        eyes.push_back(
            {settings.camera, {0, settings.eye * (1 - kDucked * walker.duck), 0}, walker.pitch});
    });
    for (const Eyes& look : eyes) {
        if (auto* transform = transforms.find<Transform>(look.camera)) {
            transform->position = look.position;
            transform->rotation = rotation_about({1, 0, 0}, look.pitch);
        }
    }
}

}  // namespace limn
