#pragma once

#include "ecs/base/math.h"
#include "ecs/components/deformers.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// Skin that the pointer pulls (face.pull): a Tug follows the pointer while the action pull_skin is
// in use, and springs back afterwards. Wrinkles then come from the compression of the pulled skin.
// Techniques: face.pull
// Source of face.pull: after the soft selection of modeling programs: a compact kernel (Wyvill et
//     al. 1986) about the place that is held, a critically damped spring

/// On a deformed mesh, which gets Deformers. Other meshes of its character that have Deformers,
/// such as brows, are pulled along.
struct PullableSkin {
    float radius = 0.04f;
    float reach = 0.02f;
    float rate = 14.0f;
};

LIMN_FIELDS(PullableSkin) {
    LIMN_FIELD(radius, "of the skin around the pointer that follows it", "m", 1e-3f, 1e3f);
    LIMN_FIELD(
        reach, "how far skin can be pulled; above 0.58 of the radius it folds over itself", "m", 0,
        1e3f);
    LIMN_FIELD(
        rate, "how fast skin springs back: after t seconds (1 + rate t) exp(-rate t) is left",
        "1/s", 0.1f, 1000);
}

/// One place that is pulled or springs back.
struct SkinPull {
    Tug tug;  ///< in the space of the mesh before joints
    Vec3 velocity{0, 0, 0};
    bool held = false;
    float distance = 0;          ///< from the eye, where it was taken [m]
    std::uint32_t triangle = 0;  ///< of the mesh, that was taken
    Vec3 shares{1, 0, 0};        ///< of its corners in the place
};

LIMN_FIELDS(SkinPull) {
    visit_fields(self.tug, visit);
    LIMN_FIELD(velocity, "of the offset", "m/s");
    LIMN_FIELD(held, "the pointer holds it; otherwise it springs back");
    LIMN_FIELD(distance, "from the eye, where it was taken", "m");
    LIMN_FIELD(triangle, "of the mesh, that was taken");
    LIMN_FIELD(shares, "of the triangle's corners in the place");
}

/// What the pulls of each PullableSkin do now; only update_skin_pulls writes it.
struct SkinPulls {
    std::vector<SkinPull> pulls;  ///< the oldest first
    bool asked = false;           ///< the action pull_skin was in use in the previous step
};

LIMN_FIELDS(SkinPulls) {
    LIMN_FIELD(pulls, "the oldest first");
    LIMN_FIELD(asked, "the action pull_skin was in use in the previous step");
}

/// Not copied with a prefab: an instance has no history.
template <>
struct ComponentTraits<SkinPulls> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
