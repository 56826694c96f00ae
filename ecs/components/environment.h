#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

namespace limn {

/// How the surroundings are lit and drawn where no surface is. A resource: one a level.
enum class SkyKind : std::uint8_t {
    Gradient,  ///< horizon to zenith, ground below, a sun disc along the first directional light
    Studio,    ///< dark room with soft boxes, made for looking at objects
    Uniform,   ///< one radiance from everywhere: white furnace, tests
    Panorama,  ///< a picture of all of it, of linear light
};
inline constexpr int kSkyKinds = 4;

/// How the picture of a Panorama shows directions (render/panorama.h).
enum class PanoramaMapping : std::uint8_t {
    Equirectangular,  ///< longitude and latitude, twice as wide as high
    Cylindrical,      ///< a stitched strip
    Angular,          ///< a disc about straight up
};

struct Environment {
    SkyKind sky = SkyKind::Gradient;
    Vec3 zenith = {0.20f, 0.38f, 0.85f};   ///< radiance, linear; the radiance of Uniform
    Vec3 horizon = {0.75f, 0.82f, 0.90f};  ///< radiance, linear
    Vec3 ground = {0.16f, 0.14f, 0.12f};   ///< radiance, linear
    float intensity = 1.0f;                ///< multiplies all of it, >= 0
    bool visible = true;                   ///< drawn as background; its light counts either way
    ImageId panorama = {};                 ///< of Panorama; none is black
    PanoramaMapping mapping = PanoramaMapping::Equirectangular;
    float rotation = 0.0f;              ///< of the panorama about the vertical [rad]
    float half_angle = radians(45.0f);  ///< Cylindrical: horizon to upper edge [rad]
};

template <typename Visitor>
void visit_fields(Environment& environment, Visitor&& visit) {
    visit(
        "sky", environment.sky,
        {.doc = "what surrounds the scene", .values = "gradient studio uniform panorama"});
    visit(
        "zenith", environment.zenith,
        {.doc = "radiance from above, or of uniform", .min = 0, .max = 1e5, .color = true});
    visit(
        "horizon", environment.horizon,
        {.doc = "radiance from the horizon", .min = 0, .max = 1e5, .color = true});
    visit(
        "ground", environment.ground,
        {.doc = "radiance from below", .min = 0, .max = 1e5, .color = true});
    visit(
        "intensity", environment.intensity, {.doc = "multiplies all of it", .min = 0, .max = 1e5});
    visit("visible", environment.visible, {.doc = "drawn as background"});
    visit("panorama", environment.panorama, {.doc = "an image of the level, by name"});
    visit(
        "mapping", environment.mapping,
        {.doc = "how the panorama shows directions",
         .values = "equirectangular cylindrical angular"});
    visit(
        "rotation", environment.rotation,
        {.doc = "of the panorama about the vertical, counter-clockwise from above", .unit = "rad"});
    visit(
        "half_angle", environment.half_angle,
        {.doc = "of a cylindrical panorama, from the horizon to its upper edge",
         .unit = "rad",
         .min = 0.01,
         .max = 1.55});
}

}  // namespace limn
