#pragma once

#include "content/make/patterns/patterns.h"

namespace limn {

enum class SolidShape : std::uint8_t { Teapot, Torus, Ball };
enum class SolidSide : std::uint8_t { Right, Left, Top, Bottom, Front, Back };

/// A solid as seen through one side of its bounding box, with a relief map that has its front and
/// its back: for the sides of a relief_box. The teapot's box is 2.041 x 1 x 1.27, that of the torus
/// 1 x 0.3 x 1.
struct SolidPattern {
    PatternSize image = {.size = 256};
    SolidShape shape = SolidShape::Teapot;
    SolidSide side = SolidSide::Front;
    Vec3 color = {0.50f, 0.45f, 0.36f};
    float roughness = 0.6f;
};

LIMN_FIELDS(SolidPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(
        shape, .doc = "teapot, in a box of 2.041 : 1 : 1.27; torus, in 1 : 0.3 : 1; or ball",
        .values = "teapot torus ball");
    LIMN_FIELD(
        side, .doc = "the side of the box, by the axis that it faces: +x, -x, +y, -y, +z, -z",
        .values = "right left top bottom front back");
    LIMN_FIELD(color, .doc = "of the stone", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(roughness, "perceptual roughness", "", 0, 1);
}

[[nodiscard]] PatternMaps make_solid(const SolidPattern& pattern);

/// The relief map alone: normals, front depth in alpha and back depth in blue. Where there is
/// nothing, as in a border of one texel, the back (0) is before the front (1), so that filtered
/// edges do not flare.
[[nodiscard]] ImageData make_solid_relief(const MeshData& mesh, SolidSide side, int size);

}  // namespace limn
