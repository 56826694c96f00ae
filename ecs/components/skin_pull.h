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
//     al. 1986) around the held point, a critically damped spring

/// On a deformed mesh, to which Deformers are added. Other meshes of the same character that have
/// Deformers, such as brows, are pulled along.
struct PullableSkin {
    float radius = 0.04f;
    float reach = 0.02f;
    float rate = 14.0f;
};

LIMN_FIELDS(PullableSkin) {
    LIMN_FIELD(radius, "radius of the skin around the pointer that follows it", "m", 1e-3f, 1e3f);
    LIMN_FIELD(
        reach, "maximum distance of a pull; above 0.58 of the radius skin folds over itself", "m",
        0, 1e3f);
    LIMN_FIELD(
        rate, "how fast skin springs back: after t seconds (1 + rate t) exp(-rate t) remains",
        "1/s", 0.1f, 1000);
}

/// One point of the skin that is pulled or springs back.
struct SkinPull {
    Tug tug;  ///< in the space of the mesh before joints
    Vec3 velocity{0, 0, 0};
    bool held = false;
    float distance = 0;          ///< from the eye when it was grabbed [m]
    std::uint32_t triangle = 0;  ///< of the mesh, that was grabbed
    Vec3 shares{1, 0, 0};        ///< barycentric coordinates of the point in it
};

LIMN_FIELDS(SkinPull) {
    visit_fields(self.tug, visit);
    LIMN_FIELD(velocity, "rate of change of the offset", "m/s");
    LIMN_FIELD(held, "the pointer holds it; otherwise it springs back");
    LIMN_FIELD(distance, "distance from the eye when it was grabbed", "m");
    LIMN_FIELD(triangle, "triangle of the mesh that was grabbed");
    LIMN_FIELD(shares, "barycentric coordinates of the point in the triangle");
}

/// State of the pulls of each PullableSkin; only update_skin_pulls writes it.
struct SkinPulls {
    std::vector<SkinPull> pulls;  ///< oldest first
    bool asked = false;           ///< the action pull_skin was in use in the previous step
};

LIMN_FIELDS(SkinPulls) {
    LIMN_FIELD(pulls, "oldest first");
    LIMN_FIELD(asked, "the action pull_skin was in use in the previous step");
}

/// Not copied with a prefab: an instance has no history.
template <>
struct ComponentTraits<SkinPulls> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
