#pragma once

#include "content/make/models/creature.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

namespace limn {

// An artist's mannequin: a figure of turned wooden limbs with ball joints, 20 joints with the
// names of a person (humanoid.h). It stands on y = 0, faces +z, its arms stretched out sideways.
// Elbows and knees are hinges, the joints of neck, head and hands have limits, the others turn
// freely. The clip "stand" lowers the arms and breathes.

struct MannequinShape {
    float height = 1.75f;
    int segments = 32;
};

LIMN_FIELDS(MannequinShape) {
    LIMN_FIELD(height, "from the soles to the top of the head", "m", 0.01, 100);
    LIMN_FIELD(segments, "around each limb", "", 8, 256);
}

[[nodiscard]] MeshData make_mannequin(const MannequinShape& shape);
[[nodiscard]] MeshRig make_mannequin_rig(const MannequinShape& shape);

}  // namespace limn
