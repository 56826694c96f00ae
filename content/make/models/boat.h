#pragma once

#include "ecs/components/surface.h"

namespace limn {

// A small gaff-rigged wooden boat: lapped planks, a deck around an open cockpit, the mast far
// forward. It faces +z, its waterline is y = 0. Its parts are separate meshes, so that each has its
// own material and the rig can rotate:
//
//     hull    the planks and the transom, rail and keel; texture along the planks
//     deck    deck and cockpit; texture along the planks
//     spars   the mast and its stay
//     rig     sail, boom and gaff; rotates about the mast, its local y axis; the sail bulges toward
//             +x, boom and gaff point to -z
//
// At a length of 6 m it has a beam of 2 m, a freeboard of 0.55 m, a draft of 0.4 m and a mast of 6
// m at z = 1.9 (mast_position).

enum class BoatPart : std::uint8_t { Hull, Deck, Spars, Rig };

struct BoatShape {
    BoatPart part = BoatPart::Hull;
    float length = 6.0f;
    int strakes = 7;
    int stations = 24;
};

LIMN_FIELDS(BoatShape) {
    LIMN_FIELD(part, .doc = "part of the boat", .values = "hull deck spars rig");
    LIMN_FIELD(length, "from transom to stem, about", "m", 0.1, 1000);
    LIMN_FIELD(strakes, "planks on each side", "", 2, 64);
    LIMN_FIELD(stations, "segments along the hull", "", 6, 512);
}

[[nodiscard]] MeshData make_boat(const BoatShape& shape);

/// Position of the mast in a boat of this length, the origin of its rig [m].
[[nodiscard]] Vec3 mast_position(float length);

}  // namespace limn
