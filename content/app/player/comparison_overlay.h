#pragma once

#include "content/app/panels/hud_style.h"

namespace limn {

class World;

/// Where two methods of shading are compared: the pointer can drag the divider, and the scanline's
/// plot has captions.
void draw_comparison_overlay(const HudStyle& style, World& world);

}  // namespace limn
