#pragma once

#include "ecs/components/surface.h"

#include <cstdint>

namespace limn {

// The body parts on which Y. Bando, "Human Skin Simulation by Generating Wrinkles along Vector
// Fields" (2001), grows furrows: a hand (Figure 6.1), a foot (6.2) and an arm (6.3), as blended
// cones and ellipsoids (implicit_model.h) about bones of an adult. A hand shows its back to +z, its
// fingers point up; a foot shows its back to +z likewise, its toes point up; an arm stands, its
// elbow down. Texture coordinates of hand and foot are those of the planar map, seen from the front
// (wrinkle.furrow.map-planar), front and back apart; those of the arm are unrolled about its axis
// (wrinkle.furrow.map-cylinder), with a seam behind.

enum class BodyPartKind : std::uint8_t { Hand, Foot, Arm };

struct BodyPartShape {
    BodyPartKind part = BodyPartKind::Hand;
    float length = 0.19f;
    int cells = 96;
};

LIMN_FIELDS(BodyPartShape) {
    LIMN_FIELD(part, .doc = "which part", .values = "hand foot arm");
    LIMN_FIELD(length, "from wrist, heel or elbow to the other end", "m", 0.01, 10);
    LIMN_FIELD(cells, "triangles along its length, about", "", 24, 256);
}

/// Centered on the origin.
[[nodiscard]] MeshData make_body_part(const BodyPartShape& shape);

}  // namespace limn
