#pragma once

#include "content/make/patterns/patterns.h"

namespace limn {

// Patterns of stone that is deep enough to be drawn with relief (Material::detail). Besides the
// maps of other patterns they make a relief map (Material::relief_texture), in which 0 and 1 are
// the highest and the lowest point; its normals are right where `relief_depth` is `relief` times
// the width of a tile.

/// Blocks in courses with deep joints and broken edges.
struct BlocksPattern {
    PatternSize image;
    float relief = 0.05f;
    int rows = 4;
    float aspect = 2.0f;
    float joint = 0.06f;
    float broken = 0.5f;
    float variation = 0.3f;
    bool odd = false;
    Vec3 color = {0.46f, 0.40f, 0.31f};
    Vec3 joint_color = {0.20f, 0.17f, 0.13f};
};

LIMN_FIELDS(BlocksPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(relief, "depth of the joints, in widths of the image", "", 0.001, 0.5);
    LIMN_FIELD(rows, "courses; rounded up to even", "", 2, 64);
    LIMN_FIELD(aspect, "mean length of a block over its height", "", 0.5, 8);
    LIMN_FIELD(joint, "width of the joints / height of a course", "", 0, 0.3);
    LIMN_FIELD(broken, "how far edges and faces are broken away", "", 0, 1);
    LIMN_FIELD(variation, "from block to block", "", 0, 1);
    LIMN_FIELD(odd, "the relief map is one for `detail` odd, of 512 pixels");
    LIMN_FIELD(color, .doc = "of the stone", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(joint_color, .doc = "of the joints", .min = 0, .max = 1, .color = true);
}

/// Carved panels: a flower of two rings of petals in a frame with a row of beads.
struct RosettesPattern {
    PatternSize image;
    float relief = 0.12f;
    int panels = 1;
    int petals = 8;
    bool pierced = false;
    bool odd = false;
    float worn = 0.3f;
    Vec3 color = {0.50f, 0.45f, 0.36f};
};

LIMN_FIELDS(RosettesPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(relief, "depth of the carving, in widths of the image", "", 0.001, 0.5);
    LIMN_FIELD(panels, "along each side of the image", "", 1, 16);
    LIMN_FIELD(petals, "of each ring", "", 3, 32);
    LIMN_FIELD(pierced, "holes around the flowers, for `detail` double_depth");
    LIMN_FIELD(odd, "the relief map is one for `detail` odd, of 512 pixels");
    LIMN_FIELD(worn, "rounding and pits", "", 0, 1);
    LIMN_FIELD(color, .doc = "of the stone", .min = 0, .max = 1, .color = true);
}

/// A fluted ball, whose normal map is in the space of the mesh `sphere`: for `detail`
/// object_normal.
struct FlutesPattern {
    PatternSize image;
    int flutes = 14;
    float depth = 0.5f;
    Vec3 color = {0.50f, 0.45f, 0.36f};
};

LIMN_FIELDS(FlutesPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(flutes, "around the axis", "", 0, 256);
    LIMN_FIELD(depth, "slope of their sides", "", 0, 4);
    LIMN_FIELD(color, .doc = "of the stone", .min = 0, .max = 1, .color = true);
}

[[nodiscard]] PatternMaps make_blocks(const BlocksPattern& pattern);
[[nodiscard]] PatternMaps make_rosettes(const RosettesPattern& pattern);
[[nodiscard]] PatternMaps make_flutes(const FlutesPattern& pattern);

/// The omni-directional displacement map (odd_map.h) of a relief map that is `depth` image widths
/// deep.
[[nodiscard]] ImageData make_odd_map(const ImageData& relief, float depth);

}  // namespace limn
