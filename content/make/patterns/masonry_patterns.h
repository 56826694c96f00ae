#pragma once

#include "content/make/patterns/patterns.h"

namespace limn {

// Patterns for Gothic buildings: stone, stained glass and a painted ceiling. The colors of glass
// are its transmittance, and lead is black: use it as emission for a window at night, or as the
// cookie of a light for its projection on the floor.

/// Blocks of equal height and varying length in courses, every second course shifted. The image is
/// `rows` courses high: with "tiling" 0.5 and 4 rows on a metric mesh, a course is half a meter.
struct AshlarPattern {
    PatternSize image;
    int rows = 4;
    float aspect = 2.0f;
    float irregular = 0.5f;
    float joint = 0.035f;
    float wear = 0.0f;
    float variation = 0.3f;
    float roughness = 0.85f;
    Vec3 color = {0.42f, 0.37f, 0.30f};
    Vec3 joint_color = {0.30f, 0.27f, 0.23f};
};

LIMN_FIELDS(AshlarPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(rows, "courses; rounded up to even", "", 2, 128);
    LIMN_FIELD(aspect, "mean length of a block over its height", "", 0.5, 8);
    LIMN_FIELD(irregular, "variation of the lengths", "", 0, 1);
    LIMN_FIELD(joint, "width of the mortar / height of a course", "", 0, 0.3);
    LIMN_FIELD(wear, "rounding and polish, as of worn floors", "", 0, 1);
    LIMN_FIELD(variation, "from block to block", "", 0, 1);
    LIMN_FIELD(roughness, "of unworn stone", "", 0, 1);
    LIMN_FIELD(color, .doc = "of the stone", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(joint_color, .doc = "of the mortar", .min = 0, .max = 1, .color = true);
}

/// A rose window that fills the image: a hub, petals around it, a roundel beyond each petal and
/// each gap. Everything that is not glass is black.
struct RoseWindowPattern {
    PatternSize image;
    int petals = 12;
    float tracery = 0.011f;
    float lead = 0.5f;
    float variation = 0.5f;
    Vec3 field = {0.02f, 0.06f, 0.45f};
    Vec3 border = {0.55f, 0.01f, 0.02f};
    Vec3 accent = {0.95f, 0.50f, 0.06f};
    Vec3 spandrel = {0.03f, 0.22f, 0.16f};
};

LIMN_FIELDS(RoseWindowPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(petals, "around the hub", "", 3, 64);
    LIMN_FIELD(tracery, "half the width of the bars / image size", "", 0, 0.1);
    LIMN_FIELD(lead, "width of the lead / width of the bars", "", 0, 1);
    LIMN_FIELD(variation, "from piece to piece", "", 0, 1);
    LIMN_FIELD(field, .doc = "most of the petals", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(
        border, .doc = "edges of the petals, and the roundels", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(accent, .doc = "medallions and hub", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(spandrel, .doc = "between all of them", .min = 0, .max = 1, .color = true);
}

/// Panes of a tall window between two borders along v.
struct StainedGlassPattern {
    PatternSize image;
    int panes = 4;
    float lead = 0.06f;
    float variation = 0.6f;
    Vec3 color = {0.10f, 0.20f, 0.42f};
    Vec3 accent = {0.50f, 0.30f, 0.05f};
    Vec3 border = {0.40f, 0.015f, 0.03f};
};

LIMN_FIELDS(StainedGlassPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(panes, "diamonds side by side", "", 1, 64);
    LIMN_FIELD(lead, "width of the lead / width of a pane", "", 0, 0.5);
    LIMN_FIELD(variation, "from pane to pane", "", 0, 1);
    LIMN_FIELD(color, .doc = "of most panes", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(accent, .doc = "of one pane in six", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(border, .doc = "along both sides", .min = 0, .max = 1, .color = true);
}

/// Stars in rows, every second row shifted.
struct StarsPattern {
    PatternSize image;
    int rows = 4;
    int points = 6;
    float radius = 0.3f;
    Vec3 color = {0.018f, 0.045f, 0.16f};
    Vec3 star_color = {0.85f, 0.58f, 0.18f};
};

LIMN_FIELDS(StarsPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(rows, "of stars; rounded up to even", "", 2, 64);
    LIMN_FIELD(points, "of a star", "", 3, 32);
    LIMN_FIELD(radius, "of a star, in rows", "", 0.05, 0.5);
    LIMN_FIELD(color, .doc = "of the sky", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(star_color, .doc = "of the stars", .min = 0, .max = 1, .color = true);
}

[[nodiscard]] PatternMaps make_ashlar(const AshlarPattern& pattern);
[[nodiscard]] PatternMaps make_rose_window(const RoseWindowPattern& pattern);
[[nodiscard]] PatternMaps make_stained_glass(const StainedGlassPattern& pattern);
[[nodiscard]] PatternMaps make_stars(const StarsPattern& pattern);

}  // namespace limn
