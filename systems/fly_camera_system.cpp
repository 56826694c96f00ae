#include "systems/fly_camera_system.h"

#include "systems/motion_kernels.h"

#include <cmath>

namespace limn {

namespace {

constexpr float kFast = 5.0f;          // by eye
constexpr float kSteepest = 0.99985f;  // sine of 89 degrees

Quat turn_about(const Vec3& axis, float angle) {
    const double half = 0.5 * static_cast<double>(angle);
    return Quat(cosine(half), axis * sine(half));
}

/// Upward part of where the camera looks: 1 is straight up.
float steepness(const Quat& rotation) {
    return (rotation * Vec3(0, 0, -1)).y;
}

bool is_upright(const Quat& rotation) {
    return (rotation * Vec3(0, 1, 0)).y >= 0;
}

}  // namespace

void step_fly_camera(Transform& transform, const FlyCamera& fly, const Input& input, float dt) {
    if (input.look != Vec2(0)) {
        const Quat turned =
            turn_about({0, 1, 0}, -input.look.x * fly.sensitivity) * transform.rotation;
        // As much of the tilt as stays short of the poles; a camera that is too steep may come
        // back.
        const bool was_upright = is_upright(turned);
        const float before = std::abs(steepness(turned));
        float tilt = -input.look.y * fly.sensitivity;
        Quat tilted = turned;
        for (int half = 0; half < 8; ++half) {
            const Quat wanted = turned * turn_about({1, 0, 0}, tilt);
            const float after = std::abs(steepness(wanted));
            if ((is_upright(wanted) || !was_upright) && (after <= kSteepest || after < before)) {
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
        const float speed = fly.speed * (input.fast ? kFast : 1.0f);
        transform.position += along * (speed * dt / std::max(length, 1.0f));
    }
}

void update_fly_cameras(
    Query<const FlyCamera, Transform, Optional<const Camera>> cameras, Res<const Input> input,
    Res<const FrameTime> time) {
    if (input->move == Vec3(0) && input->look == Vec2(0)) {
        return;
    }
    cameras.each([&](const FlyCamera& fly, Transform& transform, const Camera* camera) {
        if (camera == nullptr || camera->active) {
            step_fly_camera(transform, fly, *input, time->step);
        }
    });
}

}  // namespace limn
