#pragma once

#include "ecs/components/surface.h"

namespace limn {

// A wooden boat with one sail, as fishermen and children sail it: lapped planks, a deck around an
// open cockpit, mast far ahead, a sail between gaff and boom. It faces +z, its waterline is y = 0.
// Its parts are meshes of their own, so that each has its material and the rig can turn:
//
//     hull    the planks and the transom, rail and keel; texture along the planks
//     deck    what is trodden on; texture along the planks
//     spars   the mast and its stay, standing
//     rig     sail, boom and gaff about the mast, which is its origin's y axis; the sail's belly is
//             toward +x, boom and gaff point to -z
//
// Lengths below are those of a boat of 6 m: a beam of 2 m, 0.55 m of freeboard, 0.4 m deep, a mast
// of 6 m at z = 1.9 (mast_place).

enum class BoatPart : std::uint8_t { Hull, Deck, Spars, Rig };

struct BoatShape {
    BoatPart part = BoatPart::Hull;
    float length = 6.0f;  ///< [m], > 0
    int strakes = 7;      ///< planks on each side, >= 2
    int stations = 24;    ///< steps along it, >= 6
};

[[nodiscard]] MeshData make_boat(const BoatShape& shape);

/// Where a boat of this length has its mast: the place of its rig [m].
[[nodiscard]] Vec3 mast_place(float length);

template <typename Visitor>
void visit_fields(BoatShape& shape, Visitor&& visit) {
    visit("part", shape.part, {.doc = "which of its meshes", .values = "hull deck spars rig"});
    visit(
        "length", shape.length,
        {.doc = "from transom to stem, about", .unit = "m", .min = 0.1, .max = 1000});
    visit("strakes", shape.strakes, {.doc = "planks on each side", .min = 2, .max = 64});
    visit("stations", shape.stations, {.doc = "steps along it", .min = 6, .max = 512});
}

}  // namespace limn
