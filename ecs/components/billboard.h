#pragma once

#include "ecs/base/math.h"
#include "ecs/components/particles.h"
#include "ecs/components/periodic.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <optional>

namespace limn {

// An image on a quad that turns toward the camera, drawn with the ParticleLook of its entity and
// sorted among particles (engine.billboard): trees, flares, signs, shots.
//
// Of the look it uses the image, frames per second, size (its height), colors, color_function,
// emission, lit, cover, softness and fades. Colors are those at color_function, not over a life:
// (1 - f) first + f last.
// Techniques: engine.billboard, engine.billboard-composite

/// How the quad is turned; it lies in its local xy plane, with +y up in the image.
enum class BillboardAlignment : std::uint8_t {
    None,       ///< as the entity is
    View,       ///< parallel to the image plane
    Axis,       ///< about its local +y, to face the camera: a tree
    Composite,  ///< likewise, and a second quad across it (engine.billboard-composite): a shot
};

struct Billboard {
    BillboardAlignment alignment = BillboardAlignment::View;
    float aspect = 1;
    ImageId section = {};
    PeriodicFunction size_function = constant_function(1);
    PeriodicFunction opacity_function = constant_function(1);
    bool loop = true;
    double time = 0;
};

LIMN_FIELDS(Billboard) {
    LIMN_FIELD(
        alignment,
        .doc = "how it is turned: as its entity is; parallel to the image; about local +y toward "
               "the camera; so, with a second quad across +y",
        .values = "none view axis composite");
    LIMN_FIELD(aspect, "width, as a factor on the look's size, which is its height", "", 0, 1000);
    LIMN_FIELD(section, "image of the second quad, as wide as it is high; none: a soft disc");
    LIMN_FIELD(size_function, "factor on its extents, at least 0");
    LIMN_FIELD(opacity_function, "factor on its opacity, clamped to 0 .. 1");
    LIMN_FIELD(
        loop, "whether frames start again after the last; else its entity is destroyed then");
    LIMN_FIELD(time, "since it began: of its functions and frames", "s", 0);
}

/// Which frame is shown `time` seconds after the first one, of `count`; 0 for a rate of 0.
[[nodiscard]] std::uint32_t billboard_frame(float frame_rate, std::uint32_t count, double time);

/// How long `count` frames last that do not loop [s]; none: they do not end.
[[nodiscard]] std::optional<double>
billboard_life(const Billboard& billboard, float frame_rate, std::uint32_t count);

}  // namespace limn
