#include "systems/orbit_camera_system.h"

#include "systems/characters/view_bodies.h"
#include "systems/motion_kernels.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

// Techniques: engine.camera-lag, engine.camera-orbit, engine.look-at

namespace limn {

namespace {

constexpr float kRadiansPerPixel = 0.005f;  // by eye
constexpr float kZoomPerStep = 0.9f;        // by eye
constexpr float kMaxElevation = 1.55f;      // just short of the pole, where azimuth is undefined
constexpr float kReferenceRate = 60.0f;     // frame rate to which OrbitCamera::follow refers [Hz]

/// Unit vector along axis `i` of the target.
Vec3 target_axis(const Affine& target, int i) {
    Vec3 fallback(0);
    fallback[i] = 1;
    return normalize_or({target.row[0][i], target.row[1][i], target.row[2][i]}, fallback);
}

Vec3 origin_of(const Affine& target) {
    return {target.row[0].w, target.row[1].w, target.row[2].w};
}

void apply_input(OrbitCamera& orbit, const Input& input) {
    orbit.azimuth -= input.look.x * kRadiansPerPixel;
    orbit.elevation = std::clamp(
        orbit.elevation + input.look.y * kRadiansPerPixel, -kMaxElevation, kMaxElevation);
    orbit.distance =
        std::clamp(orbit.distance * std::pow(kZoomPerStep, input.zoom), 0.01f, 10000.0f);
}

}  // namespace

OrbitDirection orbit_direction(float azimuth, float elevation) {
    const float across = cosine(static_cast<double>(elevation));
    return {
        sine(static_cast<double>(azimuth)) * across, cosine(static_cast<double>(azimuth)) * across,
        sine(static_cast<double>(elevation))};
}

Vec3 orbit_position_z_up(const Affine& target, float azimuth, float elevation, float distance) {
    const OrbitDirection to = orbit_direction(azimuth, elevation);
    return origin_of(target)
           + distance
                 * (target_axis(target, 0) * to.side + target_axis(target, 1) * to.ahead
                    + target_axis(target, 2) * to.above);
}

Vec3 orbit_position(const Affine& target, float azimuth, float elevation, float distance) {
    const OrbitDirection to = orbit_direction(azimuth, elevation);
    return origin_of(target)
           + distance
                 * (target_axis(target, 0) * to.side + target_axis(target, 1) * to.above
                    + target_axis(target, 2) * to.ahead);
}

float lag_fraction(float follow, float dt) {
    return 1.0f - std::pow(1.0f - std::clamp(follow, 0.0f, 1.0f), dt * kReferenceRate);
}

Vec3 lag_position(const Vec3& position, const Vec3& wanted, float follow, float dt) {
    return wanted - (wanted - position) * (1.0f - lag_fraction(follow, dt));
}

Vec3 lag_position_legacy(const Vec3& position, const Vec3& wanted, float factor, float dt) {
    return position + (wanted - position) * factor * dt;
}

Mat3 look_at_frame(const Vec3& z, const Vec3& up) {
    const Vec3 backward = normalize_or(z, {0, 0, 1});
    Vec3 upward = up - backward * glm::dot(up, backward);
    if (glm::dot(upward, upward) < 1e-8f * glm::dot(up, up) || up == Vec3(0)) {
        const Vec3 size = glm::abs(backward);
        const Vec3 other = size.y <= size.x && size.y <= size.z ? Vec3(0, 1, 0)
                           : size.z <= size.x                   ? Vec3(0, 0, 1)
                                                                : Vec3(1, 0, 0);
        upward = other - backward * glm::dot(other, backward);
    }
    const Vec3 y = glm::normalize(upward);
    return {glm::cross(y, backward), y, backward};
}

Vec3 clear_view(
    std::span<const PlacedGround> grounds, const Vec3& point, const Vec3& wanted, float clearance) {
    const Vec3 way = wanted - point;
    const float distance = glm::length(way);
    if (!(distance > 0) || !std::isfinite(distance)) {
        return wanted;
    }
    const Vec3 ahead = way / distance;
    const Mat3 frame = look_at_frame(ahead, {0, 1, 0});
    const Vec3 beyond = wanted + clearance * ahead;
    float free = find_free_fraction(grounds, {point, beyond});
    for (const Vec2 corner : {Vec2(1, 1), Vec2(1, -1), Vec2(-1, 1), Vec2(-1, -1)}) {
        const Vec3 offset = clearance * (corner.x * frame[0] + corner.y * frame[1]);
        free = std::min(free, find_free_fraction(grounds, {point, beyond + offset}));
    }
    return point + std::clamp(free * (distance + clearance) - clearance, 0.0f, distance) * ahead;
}

void update_orbit_cameras(
    Query<
        OrbitCamera, Transform, WorldTransform, PreviousWorldTransform, Optional<const Camera>,
        Without<Parent>>
        cameras,
    Query<const WorldTransform> bodies, Query<const WorldTransform, With<Teleport>> teleporting,
    Query<const Pose, const WorldTransform> characters, Res<const Input> input,
    Res<const FrameTime> time, GroundQueries grounds) {
    std::optional<std::vector<PlacedGround>> placed;  // for cameras that need them
    cameras.each([&](Entity entity, OrbitCamera& orbit, Transform& transform, WorldTransform& world,
                     PreviousWorldTransform& previous, const Camera* camera) {
        if (camera != nullptr && camera->active) {
            apply_input(orbit, *input);
        }
        Affine target;
        if (!orbit.target.is_null()) {
            const auto* body = bodies.find<const WorldTransform>(orbit.target);
            if (body == nullptr) {
                return;  // destroyed: stay
            }
            target = body->world;
        }
        const Vec3 point = transform_point(target, orbit.offset);
        target = orbit.turns ? target : Affine{};
        target.row[0].w = point.x;
        target.row[1].w = point.y;
        target.row[2].w = point.z;
        Vec3 wanted = orbit_position(target, orbit.azimuth, orbit.elevation, orbit.distance);
        std::vector<JointPlaces> people;
        if (orbit.clearance > 0) {
            // A camera that lags may be much farther off than it wants to be.
            const float far = std::max(orbit.distance, glm::distance(transform.position, point));
            people = find_bodies(characters, orbit.target, point, 1.5f * far + orbit.clearance);
            wanted = look_over_bodies(people, point, wanted, orbit.clearance);
        }

        const bool jumps =
            time->frame == 0 || teleporting.contains(entity) || teleporting.contains(orbit.target);
        transform.position =
            jumps ? wanted : lag_position(transform.position, wanted, orbit.follow, time->step);
        if (orbit.clearance > 0) {
            placed = placed ? std::move(placed) : place_grounds(grounds);
            transform.position = clear_view(*placed, point, transform.position, orbit.clearance);
            transform.position =
                keep_off_bodies(people, point, transform.position, orbit.clearance);
        }
        const Vec3 back = transform.position - point;
        if (back != Vec3(0)) {
            transform.rotation = glm::quat_cast(look_at_frame(back, target_axis(target, 1)));
        }
        world.world = affine_from(transform.position, transform.rotation, transform.scale);
        if (jumps) {
            previous.world = world.world;
        }
    });
}

}  // namespace limn
