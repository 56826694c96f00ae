#pragma once

#include <imgui.h>

namespace limn {

// Style of the HUD: dark translucent panels, one warm accent, numbers in a monospaced font. Sizes
// are for a 96 dpi display and scale with its content scale and with the window's height.

inline const ImVec4 kHudAccent = {0.96f, 0.72f, 0.33f, 1.0f};
inline const ImVec4 kHudText = {0.91f, 0.92f, 0.94f, 1.0f};
inline const ImVec4 kHudDim = {0.60f, 0.63f, 0.69f, 1.0f};
inline const ImVec4 kHudGood = {0.50f, 0.83f, 0.58f, 1.0f};
inline const ImVec4 kHudBad = {0.96f, 0.45f, 0.40f, 1.0f};

/// The fonts and metrics that panels use.
struct HudStyle {
    ImFont* text = nullptr;
    ImFont* numbers = nullptr;  ///< monospaced
    ImFont* title = nullptr;
    float scale = 1.0f;      ///< pixels per layout unit
    float panel_top = 0.0f;  ///< where panels below the status line begin [pixels]
};

/// Pixels per layout unit for a window of that height [px] on a display with that content scale:
/// 1 for 720 to 900 px at a content scale of 1; larger and smaller windows have larger and
/// smaller text, of whole pixels and at least 11 times the content scale.
[[nodiscard]] float hud_scale(float content_scale, int window_height);

/// Loads the fonts (DejaVu where it is installed, ImGui's own otherwise) and sets colors and
/// spacing of the current ImGui context, for `scale` pixels per layout unit.
[[nodiscard]] HudStyle apply_hud_style(float scale);

}  // namespace limn
