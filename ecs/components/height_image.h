#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

// Techniques: particle.heightfield-collision

/// Terrain from an image: fills a HeightField, for a mesh to take its heights from and particles to
/// land on. The image covers the surface once, its top at -z.
struct HeightImage {
    ImageId image{};
    Vec2 size = {10, 10};
    std::uint32_t points = 129;
    float height = 1;
    float base = 0;
    bool operator==(const HeightImage&) const = default;
};

LIMN_FIELDS(HeightImage) {
    LIMN_FIELD(image, "its red channel is the height: 0 the base; not sRGB");
    LIMN_FIELD(size, "extent along local x and z", "m", 0.01, 1e5);
    LIMN_FIELD(points, "grid points per side", "", 2, 1024);
    LIMN_FIELD(height, "of a red of 1 above the base", "m", -1e4, 1e4);
    LIMN_FIELD(base, "height of a red of 0", "m", -1e4, 1e4);
}

/// With a HeightImage: what its HeightField was filled from.
struct HeightImageState {
    HeightImage settings{};
    std::uint32_t version = 0;  ///< of the image
};

template <>
struct ComponentTraits<HeightImageState> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
