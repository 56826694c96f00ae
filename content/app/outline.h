#pragma once

#include "ecs/base/math.h"

namespace limn {

struct RenderView;

/// Draws the edges of a box behind the panels of the HUD. `box` is in the space that `transform`
/// takes to the world; edges that pass the camera are cut at its near plane.
void draw_box_outline(const RenderView& view, const Affine& transform, const Bounds& box);

}  // namespace limn
