#include "systems/water/walker_system.h"

#include "ecs/base/rotation.h"
#include "ecs/components/camera.h"
#include "ecs/components/time.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "systems/water/water_dispersion.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace limn {
namespace {

constexpr float kLookRate = 0.003f;  // [rad] a pixel; all by eye
constexpr float kSteepest = 1.45f;   // [rad]
constexpr float kEase = 0.12f;       // [s] in which speed gets 63 % of the way
constexpr float kFast = 2.0f;        // with Input::fast
constexpr float kWading = 0.35f;     // of the speed that is left where the water is deep
constexpr float kDeep = 1.2f;        // [m]
constexpr float kAfloat = 0.25f;     // [m] over the eyes from which it swims
constexpr float kEyesAbove = 0.14f;  // [m] above the water when it swims
constexpr float kDiveSpeed = 1.2f;   // [m/s]
constexpr float kSink = 1.0f;        // [m/s] at most, in water
constexpr float kFastest = 30.0f;    // [m/s] of a fall
constexpr float kDeepest = -1e3f;    // where nobody falls on [m]
constexpr float kDuck = 3.0f;        // [1/s] at which it ducks
constexpr float kDucked = 0.55f;     // of its height that a ducked head is lower
constexpr float kSnap = 0.12f;       // [m] down to the next step without a fall
constexpr float kClimb = 8.0f;       // [1/s] at which it steps up

bool is_finite(const Vec3& v) {
    return std::isfinite(v.x + v.y + v.z);
}

/// The highest top under a cylinder about `feet` that it can step on; minus infinity: none.
float ground_under(std::span<const Ground> grounds, const Vec3& feet, float reach, float step) {
    float highest = -std::numeric_limits<float>::infinity();
    for (const Ground& ground : grounds) {
        const Vec3 local = transform_point(ground.local_from_world, feet);
        const float top = feet.y + (ground.half.y - local.y);
        if (std::abs(local.x) <= ground.half.x + reach && std::abs(local.z) <= ground.half.z + reach
            && top <= feet.y + step) {
            highest = std::max(highest, top);
        }
    }
    return highest;
}

/// Out of the sides of what is too high to step on.
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
        Vec3 way(0);
        if (past.x < past.z) {
            way.x = std::copysign(past.x, local.x);
        } else {
            way.z = std::copysign(past.z, local.z);
        }
        // Back to the world by the transpose: footings are upright and of unit scale.
        const Vec4* row = ground.local_from_world.row;
        const Vec3 out = way.x * Vec3(row[0]) + way.z * Vec3(row[2]);
        feet += out;
        const Vec3 normal = normalize_or(out, Vec3(0));
        velocity -= std::min(glm::dot(velocity, normal), 0.0f) * normal;
    }
}

/// Height of the surface above the feet; negative where there is no water.
float depth_at(std::span<const WaterSurface> waters, const Vec3& feet) {
    const auto around = find_water(waters, feet + Vec3(0, 0.02f, 0));
    return around ? around->depth + 0.02f : -1.0f;
}

}  // namespace

Ground make_ground(const Footing& footing, const Affine& world) {
    // Heading and place; scale goes into the half extents.
    const Vec3 x = {world.row[0].x, world.row[1].x, world.row[2].x};
    const Vec3 y = {world.row[0].y, world.row[1].y, world.row[2].y};
    const Vec3 z = {world.row[0].z, world.row[1].z, world.row[2].z};
    const Vec3 along = normalize_or(Vec3(x.x, 0, x.z), Vec3(1, 0, 0));
    const Vec3 across = glm::cross(along, Vec3(0, 1, 0));
    const Vec3 middle = transform_point(world, footing.offset);
    Ground ground;
    ground.half = glm::abs(footing.half) * Vec3(glm::length(x), glm::length(y), glm::length(z));
    ground.local_from_world.row[0] = Vec4(along, -glm::dot(along, middle));
    ground.local_from_world.row[1] = Vec4(0, 1, 0, -middle.y);
    ground.local_from_world.row[2] = Vec4(across, -glm::dot(across, middle));
    return ground;
}

void step_walker(
    std::span<const Ground> grounds, std::span<const WaterSurface> waters, const Input& input,
    float step, Walker& walker, Vec3& position) {
    if (!is_finite(position) || !is_finite(walker.velocity) || !(step > 0)) {
        return;
    }
    if (std::isfinite(input.look.x + input.look.y)) {
        walker.yaw = std::remainder(walker.yaw - input.look.x * kLookRate, 2 * kPi);
        walker.pitch = std::clamp(walker.pitch - input.look.y * kLookRate, -kSteepest, kSteepest);
    }
    walker.depth = depth_at(waters, position);
    const float wet = std::clamp(walker.depth / kDeep, 0.0f, 1.0f);

    const Vec3 move = is_finite(input.move) ? glm::clamp(input.move, Vec3(-1), Vec3(1)) : Vec3(0);
    const Vec3 ahead = {-std::sin(walker.yaw), 0, -std::cos(walker.yaw)};
    const Vec3 right = {-ahead.z, 0, ahead.x};
    Vec3 wanted = move.z * ahead + move.x * right;
    wanted /= std::max(glm::length(wanted), 1.0f);
    wanted *= walker.speed * (input.fast ? kFast : 1.0f) * glm::mix(1.0f, kWading, wet);
    const float share = 1 - std::exp(-step / kEase);
    Vec3& velocity = walker.velocity;
    velocity.x += (wanted.x - velocity.x) * share;
    velocity.z += (wanted.z - velocity.z) * share;

    // Who has lost the ground gets it back where it is shallow.
    const bool swims = walker.depth > walker.eye + (walker.stands ? kAfloat : -2 * kEyesAbove);
    const bool ducks = walker.depth > 0.5f * walker.eye && move.y < 0;
    walker.duck += ((ducks ? 1.0f : 0.0f) - walker.duck) * (1 - std::exp(-kDuck * step));
    const bool dives = walker.depth > 0.5f * walker.eye && move.y != 0;
    if (dives) {
        velocity.y += (kDiveSpeed * move.y - velocity.y) * share;
        // Nobody swims out of the water upward.
        const float rises = (walker.depth - walker.eye + kEyesAbove) / step;
        velocity.y = std::min(velocity.y, std::max(rises, 0.0f));
    } else if (swims) {
        const float rises = walker.depth - walker.eye + kEyesAbove;
        velocity.y += (std::clamp(2 * rises, -kDiveSpeed, kDiveSpeed) - velocity.y) * share;
    } else {
        velocity.y -= static_cast<float>(kGravity) * step;
        velocity.y = std::max(velocity.y, -glm::mix(kFastest, kSink, wet));
    }

    position += step * velocity;
    leave_walls(grounds, walker, walker.step, position, velocity);
    const float ground = ground_under(grounds, position, 0.5f * walker.radius, walker.step);
    const float above = position.y - ground;
    walker.stands = !dives && above <= (walker.stands && velocity.y <= 0 ? kSnap + walker.step : 0);
    if (above < 0) {  // a step up takes a moment; a fall ends at once
        const float lift = std::max(-above * (1 - std::exp(-kClimb * step)), -above - walker.step);
        position.y += velocity.y < -2 ? -above : std::max(lift, -step * velocity.y);
        velocity.y = std::max(velocity.y, 0.0f);
    } else if (walker.stands) {
        position.y -= above * (1 - std::exp(-kClimb * step));
        velocity.y = 0;
    }
    position.y = std::max(position.y, kDeepest);
}

void update_walkers(World& world) {
    const World& settings = world;
    const auto* input = settings.find_resource<Input>();
    const auto* time = settings.find_resource<FrameTime>();
    if (input == nullptr || time == nullptr) {
        return;
    }
    const auto walkers = world.query<Walker, Transform, Without<Parent>>();
    if (walkers.empty()) {
        return;
    }
    std::vector<Ground> grounds;
    world.query<const Footing, const WorldTransform>().each(
        [&](const Footing& footing, const WorldTransform& place) {
            grounds.push_back(make_ground(footing, place.world));
        });
    std::vector<WaterSurface> waters;
    world
        .query<
            const Water, const WorldTransform, Optional<const OceanState>,
            Optional<const WaveTable>, Optional<const RippleState>>()
        .each([&](const Water& water, const WorldTransform& place, const OceanState* ocean,
                  const WaveTable* waves, const RippleState* ripples) {
            waters.push_back({water_frame(place.world), water, ocean, waves, ripples});
        });
    struct Eyes {
        Entity camera;
        Vec3 place;
        float pitch;
    };
    std::vector<Eyes> eyes;
    walkers.each([&](Walker& walker, Transform& transform) {
        const auto* camera = settings.find<Camera>(walker.camera);
        const bool listens = camera == nullptr || camera->active;
        step_walker(
            grounds, waters, listens ? *input : Input{}, time->step, walker, transform.position);
        transform.rotation = rotation_about({0, 1, 0}, walker.yaw);
        eyes.push_back(
            {walker.camera, {0, walker.eye * (1 - kDucked * walker.duck), 0}, walker.pitch});
    });
    for (const Eyes& look : eyes) {
        if (auto* transform = world.find<Transform>(look.camera)) {
            transform->position = look.place;
            transform->rotation = rotation_about({1, 0, 0}, look.pitch);
        }
    }
}

}  // namespace limn
