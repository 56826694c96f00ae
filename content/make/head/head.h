#pragma once

#include "content/make/models/creature.h"
#include "ecs/components/surface.h"

#include <cstdint>
#include <string>

namespace limn {

// A human head with neck, facing +z, +x to its left. The skin is one triangulated quad mesh, closed
// except for the ring at the end of the neck: a grid of columns around the head and rows from crown
// to neck, with a square cap on the crown and concentric loops around eyes, mouth and ears
// (head_layout.h), wrapped around an implicit surface (head_surface.h). One UV seam runs down the
// back; a second UV set hardly stretches patterns such as pores (even_chart.h), which continue
// across the seam behind the neck if they repeat five times in a unit, or a multiple of that.
// Proportions after Farkas, "Anthropometry of the Head and Face" (1994).
//
// Regions are those of face_regions.h. Expressions are morph targets (head_expressions.h), jaw and
// eyes are joints as well: "head", "jaw", "left_eye", "right_eye". Each part is a mesh with its
// own material, and has the same morph targets:
//
//     skin      with regions that fold; the alpha of its colors is how deep its pores are
//     eyes      white, iris, pupil and caruncle, in vertex colors
//     corneas   clear shells in front of them and tear lines, for a refractive material
//     teeth     of both jaws
//     mouth     gums and tongue
//     hair      brows and lashes: ribbons, for a double-sided material
//     scalp     a short cut: cards for a material with the images of HairPattern
//     shirt     over shoulders, with a wide neckline
//     markers   not visible: a coarse surface that moves the skin (head_markers.h)

enum class HeadPartKind : std::uint8_t {
    Skin,
    Eyes,
    Corneas,
    Teeth,
    Mouth,
    Hair,
    Scalp,
    Shirt,
    Markers
};

struct HeadShape {
    HeadPartKind part = HeadPartKind::Skin;
    float age = 0.3f;
    float sex = 0.0f;
    float build = 0.0f;
    float asymmetry = 0.0f;
    float scalp_shade = 0.0f;
    bool shoulders = false;
    bool dressed = false;
    bool grows_old = false;
    bool wrinkle_channels = false;
    std::string says = "Hello. I am made of numbers, and light moves within my skin.";
};

LIMN_FIELDS(HeadShape) {
    LIMN_FIELD(
        part,
        .doc = "part of the head; markers: a coarse surface, for a surface_binding of the skin",
        .values = "skin eyes corneas teeth mouth hair scalp shirt markers");
    LIMN_FIELD(age, "0: twenty years, 1: seventy; lips thin, tissue sags", "", 0, 1);
    LIMN_FIELD(sex, "-1: a woman's features, 1: a man's", "", -1, 1);
    LIMN_FIELD(build, "-1: lean, 1: heavy", "", -1, 1);
    LIMN_FIELD(asymmetry, "asymmetry of the left and right half; 0: mirror images", "", 0, 1);
    LIMN_FIELD(scalp_shade, "how much the skin is darkened where hair grows", "", 0, 1);
    LIMN_FIELD(
        shoulders, "the skin continues over collar bones and shoulders, which stay when the head "
                   "turns; it ends in a planar ring 27 cm below the ears, otherwise 14.5 cm");
    LIMN_FIELD(
        dressed, "the skin ends some centimeters below the collar of a shirt, which is worn "
                 "over it; implies shoulders");
    LIMN_FIELD(
        grows_old, "adds the shape `age`, which at weight 1 makes it seventy years old; set it on "
                   "all parts of a head");
    LIMN_FIELD(
        wrinkle_channels,
        "the skin has channels of wrinkle_weights, which its clips set with each expression");
    LIMN_FIELD(says, "English text that it says in its clip `talk`");
}

/// In meters; the origin lies between the ears, 3.5 cm below the pupils.
[[nodiscard]] MeshData make_head(const HeadShape& shape);

/// The same skeleton for all parts. The skin has clips: each expression of head_clips.h for a few
/// seconds, "expressions" with all of them, "talk", "relax", and "blink" and "old", to be played
/// together with others.
[[nodiscard]] MeshRig make_head_rig(const HeadShape& shape);

}  // namespace limn
