#pragma once

#include "content/make/patterns.h"

namespace limn {

// Patterns for Gothic buildings: what they are built, paved, glazed and painted with. The colors of
// glass are what goes through it, and its lead is black: as emission it makes a window at night, as
// the slide of a projector its light on the floor.

/// Blocks of one height and different lengths in courses, each other course shifted. One piece of
/// the image is `rows` courses high: with "tiling" 0.5 and 4 rows on a metric mesh, half a meter.
struct AshlarPattern {
    PatternSize image;
    int rows = 4;             ///< courses
    float aspect = 2.0f;      ///< mean length of a block over its height, 0.5 .. 8
    float irregular = 0.5f;   ///< how much their lengths differ, 0 .. 1
    float joint = 0.035f;     ///< width of the mortar in heights of a course, 0 .. 0.3
    float wear = 0.0f;        ///< rounded and polished, as floors are by feet, 0 .. 1
    float variation = 0.3f;   ///< from block to block, 0 .. 1
    float roughness = 0.85f;  ///< where it is not worn
    Vec3 color = {0.42f, 0.37f, 0.30f};
    Vec3 joint_color = {0.30f, 0.27f, 0.23f};
};

/// A rose window that fills the image: a hub, petals around it, a roundel beyond each petal and
/// each gap. Everything that is not glass is black.
struct RoseWindowPattern {
    PatternSize image;
    int petals = 12;         ///< >= 3
    float tracery = 0.011f;  ///< half the width of the bars, of the image, 0 .. 0.1
    float lead = 0.5f;       ///< width of the lead between pieces of glass, of the tracery, 0 .. 1
    float variation = 0.5f;  ///< from piece to piece, 0 .. 1
    Vec3 field = {0.02f, 0.06f, 0.45f};     ///< most of the petals
    Vec3 border = {0.55f, 0.01f, 0.02f};    ///< along their edges, and the roundels
    Vec3 accent = {0.95f, 0.50f, 0.06f};    ///< medallions and the hub
    Vec3 spandrel = {0.03f, 0.22f, 0.16f};  ///< between all of them
};

/// Panes of a tall window between two borders along v.
struct StainedGlassPattern {
    PatternSize image;
    int panes = 4;           ///< diamonds side by side, >= 1
    float lead = 0.06f;      ///< width of the lead in panes, 0 .. 0.5
    float variation = 0.6f;  ///< from pane to pane, 0 .. 1
    Vec3 color = {0.10f, 0.20f, 0.42f};
    Vec3 accent = {0.50f, 0.30f, 0.05f};  ///< one pane in six
    Vec3 border = {0.40f, 0.015f, 0.03f};
};

/// Stars in rows, each other row shifted.
struct StarsPattern {
    PatternSize image;
    int rows = 4;         ///< of stars, even
    int points = 6;       ///< of a star, >= 3
    float radius = 0.3f;  ///< of a star, in rows, 0.05 .. 0.5
    Vec3 color = {0.018f, 0.045f, 0.16f};
    Vec3 star_color = {0.85f, 0.58f, 0.18f};
};

[[nodiscard]] PatternMaps make_ashlar(const AshlarPattern& pattern);
[[nodiscard]] PatternMaps make_rose_window(const RoseWindowPattern& pattern);
[[nodiscard]] PatternMaps make_stained_glass(const StainedGlassPattern& pattern);
[[nodiscard]] PatternMaps make_stars(const StarsPattern& pattern);

template <typename Visitor>
void visit_fields(AshlarPattern& p, Visitor&& visit) {
    detail::visit_image(p.image, visit);
    visit("rows", p.rows, {.doc = "courses; made even", .min = 2, .max = 128});
    visit(
        "aspect", p.aspect,
        {.doc = "mean length of a block over its height", .min = 0.5, .max = 8});
    visit("irregular", p.irregular, {.doc = "how much lengths differ", .min = 0, .max = 1});
    visit("joint", p.joint, {.doc = "width of the mortar in courses", .min = 0, .max = 0.3});
    visit("wear", p.wear, {.doc = "rounded and polished, as floors are", .min = 0, .max = 1});
    visit("variation", p.variation, {.doc = "from block to block", .min = 0, .max = 1});
    visit("roughness", p.roughness, {.doc = "where it is not worn", .min = 0, .max = 1});
    visit("color", p.color, {.doc = "of the stone", .min = 0, .max = 1, .color = true});
    visit(
        "joint_color", p.joint_color, {.doc = "of the mortar", .min = 0, .max = 1, .color = true});
}

template <typename Visitor>
void visit_fields(RoseWindowPattern& p, Visitor&& visit) {
    detail::visit_image(p.image, visit);
    visit("petals", p.petals, {.doc = "around the hub", .min = 3, .max = 64});
    visit(
        "tracery", p.tracery,
        {.doc = "half the width of the bars, of the image", .min = 0, .max = 0.1});
    visit(
        "lead", p.lead, {.doc = "width between pieces of glass, of the bars", .min = 0, .max = 1});
    visit("variation", p.variation, {.doc = "from piece to piece", .min = 0, .max = 1});
    visit("field", p.field, {.doc = "most of the petals", .min = 0, .max = 1, .color = true});
    visit(
        "border", p.border,
        {.doc = "of petals, and the roundels", .min = 0, .max = 1, .color = true});
    visit("accent", p.accent, {.doc = "medallions and hub", .min = 0, .max = 1, .color = true});
    visit(
        "spandrel", p.spandrel, {.doc = "between all of them", .min = 0, .max = 1, .color = true});
}

template <typename Visitor>
void visit_fields(StainedGlassPattern& p, Visitor&& visit) {
    detail::visit_image(p.image, visit);
    visit("panes", p.panes, {.doc = "diamonds side by side", .min = 1, .max = 64});
    visit("lead", p.lead, {.doc = "width in panes", .min = 0, .max = 0.5});
    visit("variation", p.variation, {.doc = "from pane to pane", .min = 0, .max = 1});
    visit("color", p.color, {.doc = "of most panes", .min = 0, .max = 1, .color = true});
    visit("accent", p.accent, {.doc = "of one pane in six", .min = 0, .max = 1, .color = true});
    visit("border", p.border, {.doc = "along both sides", .min = 0, .max = 1, .color = true});
}

template <typename Visitor>
void visit_fields(StarsPattern& p, Visitor&& visit) {
    detail::visit_image(p.image, visit);
    visit("rows", p.rows, {.doc = "of stars; made even", .min = 2, .max = 64});
    visit("points", p.points, {.doc = "of a star", .min = 3, .max = 32});
    visit("radius", p.radius, {.doc = "of a star, in rows", .min = 0.05, .max = 0.5});
    visit("color", p.color, {.doc = "of the sky", .min = 0, .max = 1, .color = true});
    visit("star_color", p.star_color, {.doc = "of the stars", .min = 0, .max = 1, .color = true});
}

}  // namespace limn
