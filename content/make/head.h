#pragma once

#include "ecs/components/surface.h"

namespace limn {

// A human head on its neck, facing +z, +x to its left. Skin is one closed quad mesh, cut into
// triangles, but for the ring at the end of the neck: a grid of columns around the head and rows
// from crown to neck, with a square cap on the crown and concentric loops around eyes, mouth and
// ears (head_layout.h), wrapped around an implicit surface (head_surface.h). One UV seam runs down
// the back. Proportions after Farkas, "Anthropometry of the Head and Face" (1994).
//
// Regions are those of face_regions.h. There are no eyeballs, teeth, hair or morph targets yet:
// openings of eyes and mouth end in closed pockets, which fit balls of kEyeRadius at kEyeCenter.

struct HeadShape {
    float age = 0.3f;
    float sex = 0.0f;
    float build = 0.0f;
    float asymmetry = 0.0f;
};

LIMN_FIELDS(HeadShape) {
    LIMN_FIELD(age, "0: twenty years, 1: seventy; lips thin, tissue sags", "", 0, 1);
    LIMN_FIELD(sex, "-1: a woman's features, 1: a man's", "", -1, 1);
    LIMN_FIELD(build, "-1: lean, 1: heavy", "", -1, 1);
    LIMN_FIELD(asymmetry, "of the left and right half; 0: mirror images", "", 0, 1);
}

/// In meters; the origin lies between the ears, 3.5 cm below the pupils.
[[nodiscard]] MeshData make_head(const HeadShape& shape);

}  // namespace limn
