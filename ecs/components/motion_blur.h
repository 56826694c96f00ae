#pragma once

#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// How a smear is made. All but the first are older methods, here to be compared with.
enum class MotionBlurMode : std::uint8_t {
    Reconstruct,  ///< each pixel gathers what passes it, by depth and velocity: the one to use
    Accumulate,   ///< the mean of the last pictures (post.motion-blur-accumulation)
    Camera,       ///< the camera's motion alone (post.motion-blur-camera-psf)
    Flow,         ///< objects warped along their motion (post.motion-blur-optic-flow)
    Stretch,      ///< objects stretched between two pictures (post.motion-blur-stretch)
};

/// Whether it needs the pictures before.
[[nodiscard]] constexpr bool keeps_pictures(MotionBlurMode mode) {
    return mode == MotionBlurMode::Accumulate || mode == MotionBlurMode::Stretch;
}

/// Resource: what moves while the shutter is open is smeared. Absent: as if the shutter opened for
/// no time. The exposure is centered on the moment shown and lasts shutter / 360 of the time
/// between two pictures.
struct MotionBlur {
    MotionBlurMode mode = MotionBlurMode::Reconstruct;
    float shutter = 180.0f;  ///< angle of a rotary shutter [deg], 0 = off, 360 = always open
    int samples = 16;      ///< along a smear, 2 .. 64; what fast things do costs no more than that
    float longest = 0.2f;  ///< smear, as a share of the picture's height; longer ones are cut
    int window = 5;        ///< pictures of Accumulate, 1 .. 16; has no shutter
    bool with_camera = false;  ///< Stretch: by the camera's motion, too
};

/// Half of the exposure, as a share of the time between two pictures.
[[nodiscard]] inline float half_exposure(const MotionBlur& blur) {
    return 0.5f * blur.shutter / 360.0f;
}

template <typename Visitor>
void visit_fields(MotionBlur& blur, Visitor&& visit) {
    visit(
        "mode", blur.mode,
        {.doc = "how a smear is made; all but reconstruct are older methods",
         .values = "reconstruct accumulate camera flow stretch"});
    visit(
        "shutter", blur.shutter,
        {.doc = "angle of a rotary shutter; 0 = no blur, 360 = open all the time",
         .unit = "deg",
         .min = 0,
         .max = 1440});
    visit("samples", blur.samples, {.doc = "along a smear", .min = 2, .max = 64});
    visit(
        "longest", blur.longest,
        {.doc = "smear, as a share of the picture's height; longer ones are cut",
         .min = 0.01,
         .max = 1});
    visit("window", blur.window, {.doc = "pictures of accumulate", .min = 1, .max = 16});
    visit("with_camera", blur.with_camera, {.doc = "stretch: by the camera's motion, too"});
}

}  // namespace limn
