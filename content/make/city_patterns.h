#pragma once

#include "content/make/patterns.h"

namespace limn {

// Patterns for cities at night.

/// The front of a tower: storeys of windows, of which some are lit, in groups, as offices are. All
/// that is not lit is black: as emission it makes a tower at night.
struct WindowsPattern {
    PatternSize image;
    int columns = 16;        ///< windows along u
    int rows = 24;           ///< storeys
    float lit = 0.35f;       ///< share of the windows, 0 .. 1
    float frame = 0.22f;     ///< width of what is between two windows, of a cell, 0 .. 0.9
    float variation = 0.6f;  ///< of brightness from window to window, 0 .. 1
    Vec3 color = {1.0f, 0.72f, 0.40f};
    Vec3 accent = {0.55f, 0.80f, 1.0f};  ///< of one in four
};

/// Asphalt after rain: grains and seams, and puddles that are as smooth as glass.
struct AsphaltPattern {
    PatternSize image;
    float wet = 0.45f;        ///< share of it under puddles, 0 .. 1
    float roughness = 0.55f;  ///< where it is only damp
    Vec3 color = {0.035f, 0.036f, 0.04f};
};

[[nodiscard]] PatternMaps make_windows(const WindowsPattern& pattern);
[[nodiscard]] PatternMaps make_asphalt(const AsphaltPattern& pattern);

template <typename Visitor>
void visit_fields(WindowsPattern& p, Visitor&& visit) {
    detail::visit_image(p.image, visit);
    visit("columns", p.columns, {.doc = "windows along u", .min = 1, .max = 256});
    visit("rows", p.rows, {.doc = "storeys", .min = 1, .max = 256});
    visit("lit", p.lit, {.doc = "share of the windows", .min = 0, .max = 1});
    visit("frame", p.frame, {.doc = "between two windows, of a cell", .min = 0, .max = 0.9});
    visit("variation", p.variation, {.doc = "of brightness", .min = 0, .max = 1});
    visit("color", p.color, {.doc = "of lit windows", .min = 0, .max = 1, .color = true});
    visit("accent", p.accent, {.doc = "of one in four", .min = 0, .max = 1, .color = true});
}

template <typename Visitor>
void visit_fields(AsphaltPattern& p, Visitor&& visit) {
    detail::visit_image(p.image, visit);
    visit("wet", p.wet, {.doc = "share under puddles", .min = 0, .max = 1});
    visit("roughness", p.roughness, {.doc = "where it is only damp", .min = 0, .max = 1});
    visit("color", p.color, {.doc = "dry", .min = 0, .max = 1, .color = true});
}

}  // namespace limn
