#pragma once

#include "content/app/panels/hud_style.h"

namespace limn {

class World;

/// Lets the pointer drag the divider of a shading comparison, and draws captions on the scanline
/// plot.
void draw_comparison_overlay(const HudStyle& style, World& world);

}  // namespace limn
