#pragma once

#include "ecs/base/math.h"
#include "ecs/components/environment.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <vector>

namespace limn {

// Techniques: engine.panorama

/// Very distant surroundings: an image around the camera at infinite distance, in front of the sky
/// and behind everything else, such as hills on the horizon (engine.panorama). The entity's
/// rotation turns it; its position and scale have no effect. Several layers blend in the order of
/// their entities, the farthest first. Mirrors and probes show it; it lights nothing by itself.
struct PanoramaLayer {
    ImageId image = {};
    std::vector<ImageId> faces = {};
    PanoramaMapping mapping = PanoramaMapping::Cylindrical;
    float half_angle = radians(15.0f);
    int repeat = 1;
    Vec3 color = {1, 1, 1};
    float opacity = 1.0f;
};

LIMN_FIELDS(PanoramaLayer) {
    LIMN_FIELD(image, "its alpha is opacity; the middle of the image lies ahead, toward -z");
    LIMN_FIELD(
        faces,
        "instead of `image`: six square images of one size and format, as seen from the middle of "
        "a cube: right (+x), left, up, down, front (-z), back");
    LIMN_FIELD(
        mapping,
        .doc =
            "projection of `image`; a cylinder's lowest row goes on below it, above it is nothing",
        .values = "equirectangular cylindrical angular");
    LIMN_FIELD(half_angle, "elevation of the upper edge of a cylindrical image", "rad", 0.01, 1.55);
    LIMN_FIELD(repeat, "how often `image` is repeated around the horizon", "", 1, 64);
    LIMN_FIELD(color, .doc = "radiance of white, linear RGB", .min = 0, .max = 1e5, .color = true);
    LIMN_FIELD(opacity, "factor on the image's alpha", "", 0, 1);
}

}  // namespace limn
