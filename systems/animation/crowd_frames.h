#pragma once

#include "systems/animation/pose_chain.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

namespace limn::crowd {

// What the SIMD and the scalar version of pose_chain.h share.

/// Squared length of an unpacked quaternion.
inline constexpr float kPackedLength2 = 2.0f * kPackedMax * kPackedMax;
/// sqrt(1 / kPackedLength2).
inline constexpr float kPackedUnit = 0.70710678f / kPackedMax;
// 1 / sqrt(1 - e) by the cubic through four Chebyshev nodes of 0 .. 0.05, error 1.5e-8: e is what
// is left of a squared length of 1 halfway between frames (kMinFrameCosine).
inline constexpr float kInverseRoot[] = {
    kPackedUnit * 0.9999999854f, kPackedUnit * 0.5000093520f, kPackedUnit * 0.3740719076f,
    kPackedUnit * 0.3416321824f};

/// Two neighboring frames.
struct FramePair {
    std::size_t first = 0;
    std::size_t step = 0;  ///< to the second one: 1, or 0 if there is a single frame
    float u = 0.0f;        ///< 0 .. 1
};

inline FramePair find_frames(const CrowdClip& clip, float time) {
    if (clip.frames < 2) {
        return {};
    }
    const float last = static_cast<float>(clip.frames - 1);
    float at = time * clip.rate;
    at = at > 0.0f ? std::min(at, last) : 0.0f;  // NaN: 0
    const std::size_t first = std::min(static_cast<std::size_t>(at), clip.frames - 2);
    return {first, 1, at - static_cast<float>(first)};
}

/// Of the joints that `rows` has.
inline void copy_all_constants(const CrowdClip& clip, PoseRows& rows) {
    const std::size_t stride = pose_stride(clip.joints);
    const auto copy = [&](const std::vector<float>& constants, std::size_t first,
                          std::size_t count) {
        if (constants.empty()) {
            return;
        }
        float* const to = rows.values.data() + first * rows.stride;
        if (rows.stride == stride) {
            std::memcpy(to, constants.data(), count * stride * sizeof(float));
            return;
        }
        for (std::size_t row = 0; row < count; ++row) {
            std::memcpy(
                to + row * rows.stride, constants.data() + row * stride,
                rows.stride * sizeof(float));
        }
    };
    copy(clip.rotations.constants, 0, 4);
    copy(clip.translations.constants, 4, 3);
}

}  // namespace limn::crowd
