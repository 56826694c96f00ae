#pragma once

#include "ecs/base/math.h"

namespace limn::boat {

// The sailing boat as data: lines, boards, spars and colors, for a length of 6 m [m]. Places along
// the hull are t from astern (0) to the bow (1); positions across the deck are in half-breadths.

inline constexpr float kLength = 6.0f;
inline constexpr float kHalfBeam = 1.0f;
inline constexpr float kKeel = -0.38f;      // of the rabbet amidships
inline constexpr float kLap = 0.022f;       // overlap of a plank over the one below
inline constexpr float kRail = 0.035f;      // radius
inline constexpr float kWell = 0.70f;       // half-width of the cockpit
inline constexpr float kWellBegin = 0.10f;  // t
inline constexpr float kWellEnd = 0.60f;
inline constexpr float kSole = 0.06f;     // floor of the cockpit
inline constexpr float kMastFoot = 1.9f;  // z
inline constexpr float kMastTop = 6.0f;   // y
inline constexpr float kBoomHeight = 1.0f;
inline constexpr float kBoomLength = 4.0f;
inline constexpr float kThroat = 3.7f;          // where the gaff meets the mast, y
inline constexpr Vec2 kPeak = {-2.35f, 5.75f};  // end of the gaff: z and y
inline constexpr float kBelly = 0.11f;          // depth of the sail / its chord
inline constexpr float kSailGap = 0.004f;       // between its sides

inline constexpr Vec4 kPaint = {1, 1, 1, 1};  // the material's color shows
inline constexpr Vec4 kBottom = {0.16f, 0.035f, 0.03f, 1};
inline constexpr Vec4 kTrim = {0.30f, 0.17f, 0.09f, 1};
inline constexpr Vec4 kShade = {0.55f, 0.52f, 0.50f, 1};

struct Spar {
    Vec3 a;
    Vec3 b;
    float radius_a;
    float radius_b;
    Vec4 color;
};
inline constexpr Spar kTiller = {{0, 0.62f, -3.35f}, {0, 0.78f, -2.1f}, 0.03f, 0.02f, kTrim};
inline constexpr Spar kMast[] = {
    {{0, 0.1f, kMastFoot}, {0, kMastTop, kMastFoot}, 0.06f, 0.04f, kPaint},
    {{0, 0.97f, 2.92f}, {0, kMastTop - 0.5f, kMastFoot + 0.05f}, 0.008f, 0.008f, kShade}};
inline constexpr Spar kBoomAndGaff[] = {
    {{0, kBoomHeight, -0.06f}, {0, kBoomHeight + 0.1f, -kBoomLength}, 0.035f, 0.03f, kTrim},
    {{0, kThroat, -0.06f}, {0, kPeak.y + 0.06f, kPeak.x - 0.1f}, 0.03f, 0.022f, kTrim}};

/// A board in the plane of symmetry, thickest at its center.
struct Blade {
    Vec2 fore;  ///< z of its front edge at the top and at the bottom
    Vec2 aft;
    float top;
    float bottom;
    float thickness;
    IVec2 quads;
    Vec2 uv;
};
inline constexpr Blade kBlades[] = {
    {{0.9f, 0.5f}, {-0.6f, -0.5f}, -0.3f, -1.05f, 0.12f, {8, 2}, {1, 1}},        // fin
    {{-3.14f, -2.86f}, {-3.6f, -3.35f}, 0.55f, -0.7f, 0.08f, {6, 4}, {0.4f, 1}}  // rudder
};

struct DeckStrip {
    float begin;
    float end;
    float left;
    float right;
    int columns;
};
inline constexpr DeckStrip kDeck[] = {
    {kWellEnd, 1, 1, -1, 6},
    {0, kWellBegin, 1, -1, 6},
    {kWellBegin, kWellEnd, 1, kWell, 2},
    {kWellBegin, kWellEnd, -kWell, -1, 2}};

}  // namespace limn::boat
