#pragma once

#include "ecs/components/surface.h"

#include <cstdint>

namespace limn {

// The body parts on which Y. Bando, "Human Skin Simulation by Generating Wrinkles along Vector
// Fields" (2001), grows furrows: a hand (Figure 6.1), a foot (6.2) and an arm (6.3), as lofts of
// the cross-sections of an adult (loft.h) blended with ellipsoids of bones and muscles. A hand
// shows its back to +z, its fingers point up; a foot shows its back to +z likewise, its toes point
// up; an arm stands on its elbow, its palm to +z. Nails are meshes of their own, colored per
// vertex.
//
// Texture coordinates of a hand are those of the planar map, seen from the front, at the left of
// the image, and from behind at the right (wrinkle.furrow.map-planar). A foot has its sole at the
// right; the map of its back folds down at the sides and is unrolled about the leg. Those of the
// arm are unrolled about its axis (wrinkle.furrow.map-cylinder). Seams are behind.

enum class BodyPartKind : std::uint8_t { Hand, Foot, Arm, HandNails, FootNails };

struct BodyPartShape {
    BodyPartKind part = BodyPartKind::Hand;
    float length = 0.19f;
    int cells = 96;
};

LIMN_FIELDS(BodyPartShape) {
    LIMN_FIELD(part, .doc = "which part", .values = "hand foot arm hand_nails foot_nails");
    LIMN_FIELD(
        length, "from wrist, heel or elbow to the other end, also of the body that nails are on",
        "m", 0.01, 10);
    LIMN_FIELD(cells, "triangles along its length, about", "", 24, 256);
}

/// Of the planar map: 1 would show the length of the body from top to bottom of the image.
inline constexpr float kBodyChartScale = 0.7f;

/// Centered on the origin, nails as the body that they are on.
[[nodiscard]] MeshData make_body_part(const BodyPartShape& shape);

}  // namespace limn
