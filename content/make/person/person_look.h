#pragma once

#include "content/make/person/person.h"

namespace limn {

// What a PersonShape leaves open, chosen by its seed.

/// One person: all parameters in their normal range.
struct PersonLook {
    PersonShape shape;        ///< nothing left open; sex is Woman or Man
    float child = 0.0f;       ///< 0: grown up, 1: a child of seven or less
    float infant = 0.0f;      ///< 0: grown up, 1: a child of four
    float sex = 1.0f;         ///< -1: a woman's features, 1: a man's, as of HeadShape
    float asymmetry = 0.0f;   ///< of the face
    Vec3 skin_color = {};     ///< linear
    Vec3 iris_color = {};     ///< linear
    float shirt_length = 0;   ///< of the hem below the hip joints, at a height of 1.75 m [m]
    bool tucked = false;      ///< the shirt ends within the trousers
    std::uint32_t folds = 0;  ///< seed of the folds of cloth
};

[[nodiscard]] PersonLook choose_person(const PersonShape& shape);

/// Linear color of skin by the amount of melanin, 0 .. 1: from fair to dark, through the tones of
/// the types I to VI of Fitzpatrick (1988), by eye.
[[nodiscard]] Vec3 skin_tone(float melanin);

}  // namespace limn
