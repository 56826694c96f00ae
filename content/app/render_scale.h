#pragma once

#include "ecs/base/math.h"

namespace limn {

// How many pixels are drawn for a window. A processor that draws (llvmpipe) gets 640 x 360, a GPU
// all of them; automatic scaling looks at the time of the last frames and gives as many as 60
// pictures a second allow.

struct RenderScale {
    float scale = 1.0f;        ///< drawn pixels a shown pixel, along each side
    bool automatic = false;    ///< changes by update_render_scale
    float patience = 0.0f;     ///< time since the last change [s]
    float target_ms = 16.67f;  ///< time a frame may take [ms]
};

inline constexpr int kSoftwareHeight = 360;  ///< rows that a processor draws [px]
inline constexpr float kMinScale = 0.2f;
inline constexpr float kMaxAutoScale = 1.0f;

/// `wanted`: what the user asked for, 0 = by the machine.
[[nodiscard]] RenderScale
make_render_scale(float wanted, bool automatic, bool software_gl, const IVec2& window);

/// Pixels to draw for a window of this size; even numbers, at least 16.
[[nodiscard]] IVec2 render_size(const RenderScale& scale, const IVec2& window);

/// `frame_ms`: median time of the last frames, waiting for the display included; `busy_ms`: what of
/// it was work. Changes at most twice a second; true if it did.
bool update_render_scale(RenderScale& scale, float frame_ms, float busy_ms, float dt);

}  // namespace limn
