#include "systems/lens_control_system.h"

#include "ecs/components/camera.h"
#include "ecs/components/camera_lens.h"
#include "ecs/components/input.h"
#include "ecs/components/motion_blur.h"
#include "ecs/components/time.h"
#include "ecs/world.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limn {
namespace {

constexpr float kFocusPace = 0.5f;     // e-folds of the distance in a second; all by eye
constexpr float kAperturePace = 1.5f;  // [stops/s]
constexpr float kShutterPace = 120;    // [deg/s]
constexpr float kNearest = 0.02f;      // [m]
constexpr float kFarthest = 1000;      // [m]
constexpr float kFastest = 0.5f;       // f-number
constexpr float kSlowest = 64;         // f-number: as good as a pinhole

}  // namespace

float turn_focus(float focus, float turn, float dt) {
    return std::clamp(focus * std::exp(turn * kFocusPace * dt), kNearest, kFarthest);
}

float turn_aperture(float f_number, float turn, float dt) {
    // A stop is half the light: the square root of two in the f-number.
    return std::clamp(f_number * std::exp2(-0.5f * turn * kAperturePace * dt), kFastest, kSlowest);
}

float turn_shutter(float shutter, float turn, float dt) {
    return std::clamp(shutter + turn * kShutterPace * dt, 0.0f, 360.0f);
}

void turn_lenses(World& world) {
    const auto* input = std::as_const(world).find_resource<Input>();
    const auto* time = std::as_const(world).find_resource<FrameTime>();
    if (input == nullptr || time == nullptr || input->lens == Vec3(0)) {
        return;
    }
    const Vec3 turn = glm::clamp(input->lens, Vec3(-1), Vec3(1));
    const float dt = time->step;
    world.query<const Camera, Lens, Optional<Autofocus>>().each(
        [&](const Camera& camera, Lens& lens, Autofocus* autofocus) {
            if (!camera.active) {
                return;
            }
            if (turn.x != 0) {
                lens.focus_distance = turn_focus(lens.focus_distance, turn.x, dt);
                if (autofocus != nullptr) {
                    autofocus->active = false;
                }
            }
            if (turn.y != 0) {
                lens.f_number = turn_aperture(lens.f_number, turn.y, dt);
            }
        });
    if (turn.z != 0) {
        if (auto* blur = world.find_resource<MotionBlur>()) {
            blur->shutter = turn_shutter(blur->shutter, turn.z, dt);
        }
    }
}

}  // namespace limn
