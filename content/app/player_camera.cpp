#include "content/app/player_camera.h"

#include "render/render_view.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr float kMaxPitch = radians(89.0f);
constexpr float kFastFactor = 4.0f;       // of Shift
constexpr float kEaseTime = 0.08f;        // [s] in which speed gets 63 % of the way
constexpr float kSpeedStep = 1.2f;        // of one wheel step
constexpr float kZoomStep = 0.88f;        // of one wheel step
constexpr float kMinDistance = 0.02f;     // [m]
constexpr float kMaxDistance = 10000.0f;  // [m]

Vec3 backward_of(float yaw, float pitch) {
    return {std::sin(yaw) * std::cos(pitch), -std::sin(pitch), std::cos(yaw) * std::cos(pitch)};
}

Vec3 position_of(const Affine& pose) {
    return {pose.row[0].w, pose.row[1].w, pose.row[2].w};
}

/// +z of the camera: where it does not look.
Vec3 backward_of(const Affine& pose) {
    return normalize_or({pose.row[0].z, pose.row[1].z, pose.row[2].z}, {0, 0, 1});
}

}  // namespace

const char* camera_mode_name(CameraMode mode) {
    switch (mode) {
    case CameraMode::Level:
        return "level camera";
    case CameraMode::Fly:
        return "fly";
    case CameraMode::Orbit:
        return "orbit";
    }
    return "";
}

void start_fly(PlayerCamera& camera, const Affine& pose) {
    const Vec3 backward = backward_of(pose);
    camera.mode = CameraMode::Fly;
    camera.position = position_of(pose);
    camera.pitch =
        std::clamp(std::asin(std::clamp(-backward.y, -1.0f, 1.0f)), -kMaxPitch, kMaxPitch);
    camera.yaw = std::atan2(backward.x, backward.z);
    camera.velocity = {0, 0, 0};
}

void step_fly(PlayerCamera& camera, const Input& input, float dt) {
    FlyCamera& fly = camera.fly;
    fly.speed = std::clamp(fly.speed * std::pow(kSpeedStep, input.zoom), 0.01f, 1000.0f);
    camera.yaw -= input.look.x * fly.sensitivity;
    camera.pitch = std::clamp(camera.pitch - input.look.y * fly.sensitivity, -kMaxPitch, kMaxPitch);

    const Vec3 backward = backward_of(camera.yaw, camera.pitch);
    const Vec3 right = {std::cos(camera.yaw), 0, -std::sin(camera.yaw)};
    Vec3 wanted = right * input.move.x + Vec3(0, 1, 0) * input.move.y - backward * input.move.z;
    const float length = glm::length(wanted);
    wanted *= fly.speed * (input.fast ? kFastFactor : 1.0f) / std::max(length, 1.0f);

    camera.velocity += (wanted - camera.velocity) * (1.0f - std::exp(-dt / kEaseTime));
    camera.position += camera.velocity * dt;
    camera.pose = look_at(camera.position, camera.position - backward);
}

void start_orbit(PlayerCamera& camera, const Affine& pose, const Vec3& target) {
    const Vec3 from_target = position_of(pose) - target;
    OrbitCamera& orbit = camera.orbit;
    const float distance = std::clamp(glm::length(from_target), kMinDistance, kMaxDistance);
    const Vec3 direction = normalize_or(from_target, {0, 0, 1});
    camera.mode = CameraMode::Orbit;
    camera.focus = target;
    orbit.distance = distance;
    orbit.azimuth = std::atan2(direction.x, direction.z);
    orbit.elevation =
        std::clamp(std::asin(std::clamp(direction.y, -1.0f, 1.0f)), -kMaxPitch, kMaxPitch);
}

void step_orbit(PlayerCamera& camera, const Input& input, const Vec3& target, float dt) {
    OrbitCamera& orbit = camera.orbit;
    const float sensitivity =
        camera.fly.sensitivity * 1.5f;  // by eye: circling feels slower than turning
    orbit.azimuth -= input.look.x * sensitivity;
    orbit.elevation =
        std::clamp(orbit.elevation + input.look.y * sensitivity, -kMaxPitch, kMaxPitch);
    orbit.distance = std::clamp(
        orbit.distance * std::pow(kZoomStep, input.zoom + input.move.z * dt * 8.0f),
        kMinDistance,
        kMaxDistance);

    // engine.camera-lag, in a form that does not depend on the frame rate.
    const float share = 1.0f - std::pow(1.0f - orbit.follow, dt * 60.0f);
    camera.focus += (target - camera.focus) * share;
    const Vec3 direction = backward_of(orbit.azimuth, -orbit.elevation);
    camera.position = camera.focus + direction * orbit.distance;
    camera.pose = look_at(camera.position, camera.focus);
}

}  // namespace limn
