#include "systems/fly_camera_system.h"

#include "systems/motion_kernels.h"

#include <cmath>

namespace limn {

namespace {

constexpr float kFastFactor = 5.0f;        // by eye
constexpr float kMaxSteepness = 0.99985f;  // sine of 89 degrees

Quat turn_about(const Vec3& axis, float angle) {
    const double half = 0.5 * static_cast<double>(angle);
    return Quat(cosine(half), axis * sine(half));
}

/// Upward component of the view direction: 1 is straight up.
float steepness(const Quat& rotation) {
    return (rotation * Vec3(0, 0, -1)).y;
}

bool is_upright(const Quat& rotation) {
    return (rotation * Vec3(0, 1, 0)).y >= 0;
}

}  // namespace

void step_fly_camera(Transform& transform, const FlyCamera& fly, const MoveInput& input, float dt) {
    if (input.look != Vec2(0)) {
        const Quat turned =
            turn_about({0, 1, 0}, -input.look.x * fly.sensitivity) * transform.rotation;
        // Halves the tilt until it stays short of the poles; a camera beyond the limit may return.
        const bool was_upright = is_upright(turned);
        const float before = std::abs(steepness(turned));
        float tilt = -input.look.y * fly.sensitivity;
        Quat tilted = turned;
        for (int half = 0; half < 8; ++half) {
            const Quat wanted = turned * turn_about({1, 0, 0}, tilt);
            const float after = std::abs(steepness(wanted));
            if ((is_upright(wanted) || !was_upright)
                && (after <= kMaxSteepness || after < before)) {
                tilted = wanted;
                break;
            }
            tilt *= 0.5f;
        }
        transform.rotation = glm::normalize(tilted);
    }
    const float length = glm::length(input.move);
    if (length > 0) {
        const Vec3 along =
            transform.rotation * Vec3(input.move.x, 0, -input.move.z) + Vec3(0, input.move.y, 0);
        const float speed = fly.speed * (input.fast ? kFastFactor : 1.0f);
        transform.position += along * (speed * dt / std::max(length, 1.0f));
    }
}

void update_fly_cameras(
    Query<const FlyCamera, Transform, Optional<const Camera>> cameras, Res<const Input> input,
    Res<const FrameTime> time) {
    const MoveInput control = camera_input(*input);
    if (control.move == Vec3(0) && control.look == Vec2(0)) {
        return;
    }
    cameras.each([&](const FlyCamera& fly, Transform& transform, const Camera* camera) {
        if (camera == nullptr || camera->active) {
            step_fly_camera(transform, fly, control, time->step);
        }
    });
}

}  // namespace limn
