#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

// What a Material does to a person in one mesh (content/make/person), whose vertices say which part
// of it they are: it colors skin, hair and clothes, and draws patterns of cloth. Instances of one
// mesh with different materials of this kind are one draw, and a crowd of a dozen meshes looks like
// hundreds of people.

/// Parts of a person, by the alpha of its vertex colors. Neighbors on a body are neighbors here,
/// because simplified meshes blend them.
enum class DressedPart : std::uint8_t {
    Hair,
    Skin,
    Shirt,
    Legs,
    Other,  ///< eyes, shoes; also an alpha of 1
};

constexpr float alpha_of_part(DressedPart part) {
    return 0.8f - 0.15f * static_cast<float>(part);
}

/// Drawn with the ink of a DressPart, filtered by the area of a pixel.
enum class ClothPattern : std::uint8_t {
    None,
    Stripes,  ///< up and down
    Bands,    ///< around the body
    Checks,   ///< both, half as strong where there is one
    Plaid,    ///< wide and narrow, both ways
    Dots,
    Knit,   ///< stitches, as rows of V
    Twill,  ///< diagonal lines of denim
};

struct DressPart {
    Vec3 color = {1, 1, 1};
    Vec3 ink = {1, 1, 1};
    ClothPattern pattern = ClothPattern::None;
    float repeat = 0.04f;

    bool operator==(const DressPart&) const = default;
};

LIMN_FIELDS(DressPart) {
    LIMN_FIELD(color, .doc = "factor, linear", .min = 0, .max = 4, .color = true);
    LIMN_FIELD(
        ink, .doc = "factor where the pattern is, linear", .min = 0, .max = 4, .color = true);
    LIMN_FIELD(
        pattern, .doc = "of the cloth",
        .values = "none stripes bands checks plaid dots knit twill");
    LIMN_FIELD(repeat, "length after which it repeats", "m", 0.001, 10);
}

struct Dress {
    Vec3 skin = {1, 1, 1};
    Vec3 hair = {1, 1, 1};
    DressPart shirt = {};
    DressPart legs = {};

    bool operator==(const Dress&) const = default;
};

LIMN_FIELDS(Dress) {
    LIMN_FIELD(skin, .doc = "factor of the color, linear", .min = 0, .max = 4, .color = true);
    LIMN_FIELD(hair, .doc = "likewise", .min = 0, .max = 4, .color = true);
    LIMN_FIELD(shirt, "of what is worn on the trunk");
    LIMN_FIELD(legs, "of what is worn on the legs");
}

}  // namespace limn
