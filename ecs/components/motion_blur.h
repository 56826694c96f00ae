#pragma once

#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// Motion blur method. All but the first are older methods, kept for comparison.
enum class MotionBlurMode : std::uint8_t {
    Reconstruct,  ///< each pixel gathers passing samples by depth and velocity: the one to use
    Accumulate,   ///< mean of the last frames (post.motion-blur-accumulation)
    Camera,       ///< camera motion only (post.motion-blur-camera-psf)
    Flow,         ///< objects warped along their motion (post.motion-blur-optic-flow)
    Stretch,      ///< objects stretched between two frames (post.motion-blur-stretch)
};

/// Whether the method needs previous frames.
[[nodiscard]] constexpr bool needs_previous_frames(MotionBlurMode mode) {
    return mode == MotionBlurMode::Accumulate || mode == MotionBlurMode::Stretch;
}

/// Resource: motion blur during an exposure of shutter / 360 of the frame time, centered on the
/// time of the frame. Absent: no blur.
struct MotionBlur {
    MotionBlurMode mode = MotionBlurMode::Reconstruct;
    float shutter = 180.0f;
    int samples = 16;
    float max_length = 0.2f;
    int window = 5;  ///< frames averaged by Accumulate, 1 .. 16, which ignores the shutter
    bool with_camera = false;
};

LIMN_FIELDS(MotionBlur) {
    LIMN_FIELD(
        mode, .doc = "motion blur method; all but reconstruct are older ones",
        .values = "reconstruct accumulate camera flow stretch");
    LIMN_FIELD(
        shutter, "angle of a rotary shutter; 0 = no blur, 360 = always open", "deg", 0, 1440);
    LIMN_FIELD(samples, "samples along the blur", "", 2, 64);
    LIMN_FIELD(
        max_length, .doc = "largest blur length, as a fraction of the image height", .min = 0.01,
        .max = 1, .renamed = "longest");
    LIMN_FIELD(window, "frames averaged by accumulate", "", 1, 16);
    LIMN_FIELD(with_camera, "stretch: includes camera motion");
}

/// Half of the exposure, as a fraction of the time between two frames.
[[nodiscard]] inline float half_exposure(const MotionBlur& blur) {
    return 0.5f * blur.shutter / 360.0f;
}

}  // namespace limn
