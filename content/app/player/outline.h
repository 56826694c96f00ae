#pragma once

#include "ecs/base/math.h"

namespace limn {

struct RenderView;

/// Draws the edges of a box behind the HUD's panels. `transform` maps the space of `box` to the
/// world; edges are clipped at the near plane.
void draw_box_outline(const RenderView& view, const Affine& transform, const Bounds& box);

}  // namespace limn
