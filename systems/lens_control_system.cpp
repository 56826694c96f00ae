#include "systems/lens_control_system.h"

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr float kFocusRate = 0.5f;     // e-foldings of the distance per second; rates are by eye
constexpr float kApertureRate = 1.5f;  // [stops/s]
constexpr float kShutterRate = 120;    // [deg/s]
constexpr float kMinFocus = 0.02f;     // [m]
constexpr float kMaxFocus = 1000;      // [m]
constexpr float kMinFNumber = 0.5f;
constexpr float kMaxFNumber = 64;  // practically a pinhole

}  // namespace

float adjust_focus(float focus, float turn, float dt) {
    return std::clamp(focus * std::exp(turn * kFocusRate * dt), kMinFocus, kMaxFocus);
}

float adjust_aperture(float f_number, float turn, float dt) {
    // A stop halves the light: a factor of sqrt(2) in the f-number.
    return std::clamp(
        f_number * std::exp2(-0.5f * turn * kApertureRate * dt), kMinFNumber, kMaxFNumber);
}

float adjust_shutter(float shutter, float turn, float dt) {
    return std::clamp(shutter + turn * kShutterRate * dt, 0.0f, 360.0f);
}

void adjust_lenses(
    Query<const Camera, Lens, Optional<Autofocus>> lenses, OptionalRes<MotionBlur> blur,
    Res<const Input> input, Res<const FrameTime> time) {
    const Vec3 turn = {
        action_axis(*input, "focus_farther", "focus_nearer"),
        action_axis(*input, "aperture_open", "aperture_close"),
        action_axis(*input, "shutter_longer", "shutter_shorter")};
    if (turn == Vec3(0)) {
        return;
    }
    const float dt = time->step;
    lenses.each([&](const Camera& camera, Lens& lens, Autofocus* autofocus) {
        if (!camera.active) {
            return;
        }
        if (turn.x != 0) {
            lens.focus_distance = adjust_focus(lens.focus_distance, turn.x, dt);
            if (autofocus != nullptr) {
                autofocus->active = false;
            }
        }
        if (turn.y != 0) {
            lens.f_number = adjust_aperture(lens.f_number, turn.y, dt);
        }
    });
    if (turn.z != 0 && blur) {
        blur->shutter = adjust_shutter(blur->shutter, turn.z, dt);
    }
}

}  // namespace limn
