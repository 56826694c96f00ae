#pragma once

#include "ecs/components/surface.h"

#include <cstdint>
#include <vector>

namespace limn {

// Techniques: tex.layer-stack

/// How a layer is combined with those below it.
enum class LayerBlend : std::uint8_t { Replace, Add, Multiply, Alpha, Map };

/// An image that may move, in a stack of them.
struct TextureLayer {
    ImageId image = {};
    LayerBlend blend = LayerBlend::Alpha;
    ImageId map = {};
    bool inverted = false;
    Vec3 factor = {1, 1, 1};
    Vec2 scale = {1, 1};
    Vec2 scroll = {0, 0};
    float spin = 0.0f;
    float wave = 0.0f;
};

LIMN_FIELDS(TextureLayer) {
    LIMN_FIELD(image, "of the layer; repeats");
    LIMN_FIELD(
        blend,
        .doc = "with the layers below: instead of them, sum, product, over them by its alpha or "
               "by the red of the map",
        .values = "replace add multiply alpha map");
    LIMN_FIELD(map, "of blend map, over the whole target");
    LIMN_FIELD(inverted, "alpha and map: 0 covers, 1 does not");
    LIMN_FIELD(factor, .doc = "of the color", .min = 0, .max = 16, .color = true);
    LIMN_FIELD(scale, "repetitions along u and v", "", -1000, 1000);
    LIMN_FIELD(scroll, "speed along u and v", "1/s", -100, 100);
    LIMN_FIELD(spin, "about the center, counter-clockwise", "rad/s", -100, 100);
    LIMN_FIELD(wave, "amplitude of a wave along u that runs down v", "", 0, 1);
}

/// Images blended into one before each frame (tex.layer-stack); materials that use the target show
/// it.
struct TextureLayers {
    ImageId target = {};  ///< rendered to; keeps its size and format
    std::vector<TextureLayer> layers = {};
};

LIMN_FIELDS(TextureLayers) {
    LIMN_FIELD(target, "image to render to");
    LIMN_FIELD(layers, "from the lowest, which is over black, to the highest");
}

}  // namespace limn
