#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

// Techniques: engine.obfuscating-point

/// Dazzles whoever looks toward the entity: the whole image goes to a color, as far as the entity
/// is visible and near the center of the view (engine.obfuscating-point). With a
/// DirectionalLight, toward where that comes from.
struct Dazzle {
    Vec3 color = {1.0f, 0.9f, 0.75f};
    float opacity = 0.7f;
    float angle = radians(25.0f);
    float source_size = 0.03f;
};

LIMN_FIELDS(Dazzle) {
    LIMN_FIELD(
        color, .doc = "radiance that the image goes to, linear RGB", .min = 0, .max = 1000,
        .color = true);
    LIMN_FIELD(opacity, "opacity when the camera looks straight at it", "", 0, 1);
    LIMN_FIELD(angle, "from the view direction, where it has faded to 0", "rad", 0, 1.5708);
    LIMN_FIELD(
        source_size,
        "diameter of what must be in sight, as a fraction of the image height; hidden in part, it "
        "dazzles in part",
        "", 0, 1);
}

}  // namespace limn
