#include "content/app/player/player_camera.h"

#include "ecs/world.h"
#include "render/render_view.h"
#include "systems/fly_camera_system.h"
#include "systems/orbit_camera_system.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr float kMaxElevation = radians(88.8f);  // OrbitCamera::elevation's range
constexpr float kEaseTime = 0.08f;               // [s] time constant: 63 % of a change of speed
constexpr float kStill = 1e-3f;                  // fraction of full speed treated as 0
constexpr float kSpeedStep = 1.2f;               // of one wheel step
constexpr float kCameraZoomStep = 0.88f;         // of one wheel step
constexpr float kZoomKeys = 8.0f;                // wheel steps per second of W and S
constexpr float kMinSpeed = 0.1f;                // [unit/s], so that walls do not stop the camera
constexpr float kMaxSpeed = 1000.0f;             // [unit/s]
constexpr float kViewDistanceTime = 0.4f;        // [s] time constant of PlayerCamera::view_distance
constexpr float kMinDistance = 0.02f;            // [unit]
constexpr float kMaxDistance = 10000.0f;         // [unit]

Vec3 position_of(const Affine& pose) {
    return transform_point(pose, {0, 0, 0});
}

Quat rotation_of(const Affine& pose) {
    return glm::normalize(glm::quat_cast(Mat3(to_mat4(pose))));
}

float clamp_distance(const PlayerCamera& camera, float distance) {
    return std::clamp(distance, kMinDistance * camera.unit, kMaxDistance * camera.unit);
}

}  // namespace

const char* camera_mode_name(CameraMode mode) {
    switch (mode) {
    case CameraMode::Level:
        return "scene camera";
    case CameraMode::Fly:
        return "fly";
    case CameraMode::Orbit:
        return "orbit";
    }
    return "";
}

Entity follow_active_camera(const World& world, Entity current) {
    const auto* const camera = world.find<Camera>(current);
    return camera != nullptr && camera->active ? current : find_camera(world).value_or(current);
}

void start_fly(PlayerCamera& camera, const Affine& pose) {
    const Vec3 position = position_of(pose);
    const Vec3 ahead = transform_point(pose, {0, 0, -1});
    camera.mode = CameraMode::Fly;
    camera.fly_pose = {.position = position, .rotation = rotation_of(look_at(position, ahead))};
    camera.glide = {0, 0, 0};
}

void step_fly(PlayerCamera& camera, const MoveInput& input, float dt) {
    camera.pace = std::clamp(camera.pace * std::pow(kSpeedStep, input.zoom), 0.02f, 20.0f);
    camera.fly.speed = std::clamp(
        camera.pace * camera.view_distance, kMinSpeed * camera.unit, kMaxSpeed * camera.unit);
    const Vec3 wanted = input.move / std::max(glm::length(input.move), 1.0f);
    camera.glide += (wanted - camera.glide) * (1.0f - std::exp(-dt / kEaseTime));
    if (input.move == Vec3(0) && glm::length(camera.glide) < kStill) {
        camera.glide = {0, 0, 0};
    }
    MoveInput eased = input;
    eased.move = camera.glide;
    step_fly_camera(camera.fly_pose, camera.fly, eased, dt);
    camera.pose = affine_from(camera.fly_pose.position, camera.fly_pose.rotation, Vec3(1));
}

void update_view_distance(PlayerCamera& camera, float ahead, float scene_radius, float dt) {
    const float wanted = clamp_distance(camera, std::min(ahead, scene_radius));
    const float blend = 1.0f - std::exp(-dt / kViewDistanceTime);
    camera.view_distance *=
        std::pow(wanted / camera.view_distance, blend);  // equal times for growing and shrinking
}

void stop_at_floor(PlayerCamera& camera, std::optional<float> floor) {
    const float before = position_of(camera.previous).y;
    const float eye_height = kEyeHeight * camera.unit;
    if (!floor || *floor < eye_height || camera.fly_pose.position.y >= before) {
        return;
    }
    camera.fly_pose.position.y = std::max(camera.fly_pose.position.y, before - *floor + eye_height);
    camera.pose = affine_from(camera.fly_pose.position, camera.fly_pose.rotation, Vec3(1));
}

float framing_distance(const PlayerCamera& camera, float radius, float aspect) {
    const float up = std::tan(0.5f * camera.lens.fov_y);
    const float half_angle = std::atan(up * std::min(aspect, 1.0f));
    return 1.15f * std::max(radius, kMinDistance * camera.unit) / std::sin(half_angle);
}

void start_orbit(PlayerCamera& camera, const Affine& pose, const Vec3& target) {
    const Vec3 from_target = position_of(pose) - target;
    const Vec3 direction = normalize_or(from_target, {0, 0, 1});
    OrbitCamera& orbit = camera.orbit;
    camera.mode = CameraMode::Orbit;
    camera.aim = target;
    camera.focus = target;
    orbit.distance = clamp_distance(camera, glm::length(from_target));
    orbit.azimuth = std::atan2(direction.x, direction.z);
    orbit.elevation =
        std::clamp(std::asin(std::clamp(direction.y, -1.0f, 1.0f)), -kMaxElevation, kMaxElevation);
}

void pan_orbit(PlayerCamera& camera, const Vec2& motion, float height) {
    const float pixel =
        2 * camera.orbit.distance * std::tan(0.5f * camera.lens.fov_y) / std::max(height, 1.0f);
    const Vec3 origin = position_of(camera.pose);
    const Vec3 right = transform_point(camera.pose, {1, 0, 0}) - origin;
    const Vec3 up = transform_point(camera.pose, {0, 1, 0}) - origin;
    const Vec3 shift = pixel * (motion.y * up - motion.x * right);
    camera.aim += shift;
    camera.focus += shift;
}

void step_orbit(PlayerCamera& camera, const MoveInput& input, const Vec3& target, float dt) {
    OrbitCamera& orbit = camera.orbit;
    const float sensitivity =
        1.5f * camera.fly.sensitivity;  // by eye: orbiting feels slower than turning
    const float zoom = input.zoom + kZoomKeys * input.move.z * dt;
    orbit.azimuth -= input.look.x * sensitivity;
    orbit.elevation =
        std::clamp(orbit.elevation + input.look.y * sensitivity, -kMaxElevation, kMaxElevation);
    orbit.distance = clamp_distance(camera, orbit.distance * std::pow(kCameraZoomStep, zoom));

    camera.focus = lag_position(camera.focus, target, orbit.follow, dt);
    const Affine frame = affine_from(camera.focus, {1, 0, 0, 0}, Vec3(1));
    const Vec3 position = orbit_position(frame, orbit.azimuth, orbit.elevation, orbit.distance);
    camera.pose = look_at(position, camera.focus);
}

}  // namespace limn
