#pragma once

#include "content/make/models/creature.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

namespace limn {

// A flexible bar around +y, from y = 0 to its height, with two joints and a smooth transition of
// weights: the simplest demonstration of how skinning deforms a volume. Clips turn the upper joint:
// "twist" about the bar, "bend" across it. Skin wrinkles where it is compressed along the bar in
// its region "along", around it in "around".

struct BarShape {
    float radius = 0.12f;
    float height = 1.0f;
    int sides = 4;
    int rings = 32;
    float taper = 1;
    bool smooth = false;
};

LIMN_FIELDS(BarShape) {
    LIMN_FIELD(radius, "distance of the cross section's corners from the axis", "m", 1e-4, 1e5);
    LIMN_FIELD(height, "along y", "m", 1e-4, 1e5);
    LIMN_FIELD(sides, "of the cross section", "", 3, 256);
    LIMN_FIELD(rings, "quads along the height", "", 2, 1024);
    LIMN_FIELD(taper, "radius at the top / radius at the bottom", "", 0.01, 10);
    LIMN_FIELD(smooth, "round, with one image around it; otherwise flat sides with an image each");
}

[[nodiscard]] MeshData make_bar(const BarShape& shape);

/// Joints "base" at y = 0 and "tip" at half the height; clips of 4 s, there and back.
[[nodiscard]] MeshRig make_bar_rig(const BarShape& shape);

}  // namespace limn
