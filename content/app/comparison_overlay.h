#pragma once

#include "content/app/hud_style.h"

namespace limn {

class World;

/// Where two methods of shading are compared: their names beside the divider, which the pointer can
/// drag, and captions of the scanline's plot.
void draw_comparison_overlay(const HudStyle& style, World& world);

}  // namespace limn
