#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

namespace limn {

/// Kind of sky: background and image-based lighting of the scene.
enum class SkyKind : std::uint8_t {
    Gradient,    ///< horizon to zenith, ground below, a sun disc along the first directional light
    Studio,      ///< dark room with soft boxes, for viewing objects
    Uniform,     ///< constant radiance: white furnace, tests
    Panorama,    ///< panorama image with linear radiance
    Atmosphere,  ///< air that scatters the light of the first Sunlight
};
inline constexpr int kSkyKinds = 5;

/// Projection of a Panorama (render/environment/panorama.h).
enum class PanoramaMapping : std::uint8_t {
    Equirectangular,  ///< longitude and latitude, aspect ratio 2:1
    Cylindrical,      ///< a stitched strip
    Angular,          ///< a disc centered on the zenith
};

/// Resource: the environment of a level.
struct Environment {
    SkyKind sky = SkyKind::Gradient;
    Vec3 zenith = {0.20f, 0.38f, 0.85f};
    Vec3 horizon = {0.75f, 0.82f, 0.90f};
    Vec3 ground = {0.16f, 0.14f, 0.12f};
    float intensity = 1.0f;
    bool visible = true;
    ImageId panorama = {};  ///< for Panorama; none: black
    PanoramaMapping mapping = PanoramaMapping::Equirectangular;
    float rotation = 0.0f;
    float half_angle = radians(45.0f);
    float haze = 5.0f;
};

LIMN_FIELDS(Environment) {
    LIMN_FIELD(sky, .doc = "kind of sky", .values = "gradient studio uniform panorama atmosphere");
    LIMN_FIELD(
        zenith, .doc = "radiance at the zenith, or of uniform", .min = 0, .max = 1e5,
        .color = true);
    LIMN_FIELD(horizon, .doc = "radiance at the horizon", .min = 0, .max = 1e5, .color = true);
    LIMN_FIELD(
        ground, .doc = "radiance from below; of atmosphere: the albedo of the ground", .min = 0,
        .max = 1e5, .color = true);
    LIMN_FIELD(intensity, "factor on all radiances", "", 0, 1e5);
    LIMN_FIELD(visible, "drawn as background; lights the scene even if it is not drawn");
    LIMN_FIELD(panorama, "an image of the level, by name");
    LIMN_FIELD(
        mapping, .doc = "projection of the panorama",
        .values = "equirectangular cylindrical angular");
    LIMN_FIELD(rotation, "rotation of the panorama, counter-clockwise as seen from above", "rad");
    LIMN_FIELD(
        half_angle, "elevation of the upper edge of a cylindrical panorama", "rad", 0.01, 1.55);
    LIMN_FIELD(
        haze, "of atmosphere: factor on the haze of very clear air; 20 = a summer day", "", 0, 100);
}

}  // namespace limn
