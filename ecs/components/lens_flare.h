#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// Techniques: engine.lens-flare

/// How the light that a lens reflects within itself is drawn.
enum class LensFlareMode : std::uint8_t {
    Ghosts,      ///< images of the aperture, where the surfaces of a real lens reflect them
    Billboards,  ///< sprites on the line from the light through the center of the image
};

enum class FlareShape : std::uint8_t { Disc, Polygon, Ring, Glow };

/// A sprite of LensFlareMode::Billboards.
struct FlareElement {
    float place = 0.5f;
    float size = 0.1f;
    Vec3 tint = {0.01f, 0.01f, 0.01f};
    FlareShape shape = FlareShape::Polygon;

    bool operator==(const FlareElement&) const = default;
};

LIMN_FIELDS(FlareElement) {
    LIMN_FIELD(
        place, "0 = at the light, 0.5 = center of the image, 1 = opposite the light", "", -4, 4);
    LIMN_FIELD(size, "diameter, as a fraction of the image height", "", 0, 4);
    LIMN_FIELD(
        tint, .doc = "radiance per lx of the light", .unit = "1/sr", .min = 0, .max = 100,
        .color = true);
    LIMN_FIELD(shape, .doc = "what the sprite shows", .values = "disc polygon ring glow");
}

/// Lens flare of the Camera on the same entity: reflections between the surfaces of its lens, of
/// every light in view. The lens is a double Gauss, scaled to the camera's field of view.
struct LensFlare {
    LensFlareMode mode = LensFlareMode::Ghosts;
    float strength = 1.0f;
    float f_number = 4.0f;
    int blades = 6;
    float blade_rotation = 0.25f;
    float coating = 550.0f;
    float coating_spread = 90.0f;
    int ghosts = 24;
    float source_size = 0.012f;
    float lamp_radius = 0.3f;
    std::vector<FlareElement> elements = {
        {0.0f, 0.5f, {0.08f, 0.07f, 0.05f}, FlareShape::Glow},
        {0.3f, 0.05f, {0.05f, 0.036f, 0.016f}, FlareShape::Polygon},
        {0.42f, 0.12f, {0.008f, 0.016f, 0.02f}, FlareShape::Polygon},
        {0.58f, 0.04f, {0.016f, 0.04f, 0.024f}, FlareShape::Disc},
        {0.7f, 0.18f, {0.016f, 0.012f, 0.02f}, FlareShape::Polygon},
        {0.85f, 0.08f, {0.012f, 0.024f, 0.036f}, FlareShape::Disc},
        {1.0f, 0.4f, {0.012f, 0.012f, 0.016f}, FlareShape::Ring}};

    bool operator==(const LensFlare&) const = default;
};

LIMN_FIELDS(LensFlare) {
    LIMN_FIELD(
        mode, .doc = "reflections traced through a real lens, or sprites placed by `elements`",
        .values = "ghosts billboards");
    LIMN_FIELD(strength, "factor on its brightness; 1 = physical, 0 = off", "", 0, 1000);
    LIMN_FIELD(f_number, "focal length / aperture diameter: size of the ghosts", "", 2, 32);
    LIMN_FIELD(blades, "number of aperture blades; fewer than 3: round", "", 0, 16);
    LIMN_FIELD(blade_rotation, "angle of the first aperture corner, from right toward up", "rad");
    LIMN_FIELD(
        coating, "wavelength that the anti-reflective coatings are made for; 0 = uncoated", "nm", 0,
        2000);
    LIMN_FIELD(
        coating_spread, "how much that wavelength differs from surface to surface", "nm", 0, 200);
    LIMN_FIELD(ghosts, "number of ghosts, the brightest first", "", 0, 64);
    LIMN_FIELD(
        source_size, "diameter of a light, as a fraction of the image height: how soft ghosts are",
        "", 0, 0.5);
    LIMN_FIELD(
        lamp_radius, "what is closer to a point or spot light than this does not hide it", "m", 0,
        10);
    LIMN_FIELD(elements, "sprites of mode billboards");
}

}  // namespace limn
