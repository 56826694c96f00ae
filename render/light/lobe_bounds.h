#pragma once

#include "ecs/base/math.h"
#include "render/material/shading_models.h"

#include <array>

namespace limn {

class RenderItems;
struct RenderView;

// Screen bounds of the surfaces of each lobe (ShadingModelRow::lobe) in a view: full-screen passes
// for a single lobe are restricted to these pixels.

/// Pixels low .. high - 1 of a view, counted from the bottom; empty unless low < high.
struct PixelBounds {
    IVec2 low = {0, 0};
    IVec2 high = {0, 0};
};

[[nodiscard]] bool is_empty(const PixelBounds& bounds);

/// By lobe_number().
using LobeBounds = std::array<PixelBounds, kMaxShadingModels>;

/// Bounds of `items` by the lobe of their material. A box that straddles the camera plane counts as
/// the whole view, and so does the base lobe.
[[nodiscard]] LobeBounds find_lobe_bounds(const RenderItems& items, const RenderView& view);

}  // namespace limn
