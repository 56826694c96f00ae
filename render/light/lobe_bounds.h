#pragma once

#include "ecs/base/math.h"
#include "render/material/shading_models.h"

#include <array>

namespace limn {

class RenderItems;
struct RenderView;

// Where a view may show the surfaces of each lobe (ShadingModelRow::lobe): the pixels within which
// passes over the screen that are for one lobe alone are drawn.

/// Pixels low .. high - 1 of a view, from below; none if they are not in this order.
struct PixelBounds {
    IVec2 low = {0, 0};
    IVec2 high = {0, 0};
};

[[nodiscard]] bool is_empty(const PixelBounds& bounds);

/// By lobe_number().
using LobeBounds = std::array<PixelBounds, kMaxShadingModels>;

/// Of what is drawn with the materials of `items`. Boxes of items that reach behind the camera, but
/// are not all behind it, and all items of the base lobe count as the whole view.
[[nodiscard]] LobeBounds find_lobe_bounds(const RenderItems& items, const RenderView& view);

}  // namespace limn
