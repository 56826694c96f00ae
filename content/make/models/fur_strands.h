#pragma once

#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

// Strands of hair grown on another mesh: ribbons whose roots are spread evenly over its area. They
// have the skin weights and morph targets of their roots, so they move with it, and are shaded and
// shadowed like any mesh; the shading model `hair` is made for them. Over the shells of a coat
// (Fur), a few thousand give it an outline of single hairs.
// Techniques: shade.fur

/// Lengths, directions and colors are as those of Fur.
struct StrandsShape {
    MeshId mesh;
    int count = 5000;
    float length = 0.03f;
    float width = 0.0008f;
    int rows = 4;
    float shortest = 0.5f;
    Vec3 comb = {0, 0, 0};
    float droop = 0.4f;
    float unruly = 0.25f;
    float root = 0.4f;
    Vec3 tip = {1, 1, 1};
    float variation = 0.3f;
    std::uint32_t seed = 1;
};

LIMN_FIELDS(StrandsShape) {
    LIMN_FIELD(mesh, "the mesh that they grow on, by name; must come earlier in the file");
    LIMN_FIELD(count, "strands", "", 0, 200000);
    LIMN_FIELD(length, "along normals; the alpha of the mesh's colors scales it", "m", 1e-5, 100);
    LIMN_FIELD(width, "of a strand at its root", "m", 1e-6, 10);
    LIMN_FIELD(rows, "of vertices along a strand: more bend more smoothly", "", 2, 32);
    LIMN_FIELD(shortest, "length of the shortest strands; that of the longest is 1", "", 0.05, 1);
    LIMN_FIELD(
        comb, "how far tips lie from their roots along the surface, in lengths: the direction of "
              "the coat");
    LIMN_FIELD(droop, "the same toward -y", "", 0, 10);
    LIMN_FIELD(unruly, "how much single strands are out of line", "", 0, 2);
    LIMN_FIELD(root, "brightness at the skin, where strands shade each other", "", 0, 1);
    LIMN_FIELD(
        tip, .doc = "color of tips, multiplied by that of roots", .min = 0, .max = 4,
        .color = true);
    LIMN_FIELD(variation, "of brightness between strands", "", 0, 1);
    LIMN_FIELD(seed, "random seed");
}

/// Fins of fur (Lengyel et al. 2001): cards on the edges of another mesh, for an entity with Fur
/// and its `fins`. They fill the gaps between shells where these are seen edge-on.
struct FinsShape {
    MeshId mesh;
    int rows = 5;
};

LIMN_FIELDS(FinsShape) {
    LIMN_FIELD(mesh, "the mesh that they stand on, by name; must come earlier in the file");
    LIMN_FIELD(rows, "of vertices along a fin: more bend more smoothly", "", 2, 32);
}

/// One fin per edge, whatever seams it has. It has no height yet: that is the second v, 0 .. 1,
/// for shaders; the second u is along edges [m]. Other attributes are those of roots. Empty without
/// a mesh or normals.
[[nodiscard]] MeshData make_fins(const FinsShape& shape, const Assets& assets);

/// Texture coordinates are those of roots. Empty without a mesh, or one without area or fur.
[[nodiscard]] MeshData make_strands(const StrandsShape& shape, const Assets& assets);

}  // namespace limn
