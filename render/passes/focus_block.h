#pragma once

#include "ecs/base/math.h"
#include "render/shaders/focus_gpu.h"

namespace limn {

struct RenderView;

// What the passes of the depth of field know of a lens: its circles, and how discs that are as wide
// are spread over the pixels of the picture and over the texels of its half.

/// Of sizes that are odd, too: a texel shows what is left.
[[nodiscard]] inline IVec2 half_of(const IVec2& size) {
    return (size + 1) / 2;
}

/// Diameter of the widest disc that is drawn [px].
[[nodiscard]] int widest_circle(const RenderView& view);

[[nodiscard]] layout::FocusBlock make_focus_block(const RenderView& view);

}  // namespace limn
