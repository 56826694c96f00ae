#pragma once

#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <array>
#include <cstdint>
#include <vector>

namespace limn {

// Wrinkles under an animator's control (wrinkle.maps.*): a face has wrinkle maps for its two
// extremes, stretched skin (surprise) and compressed skin (a sour lemon); masks divide it into
// regions, and the weight of each region blends in one map or the other.
// After Oat, "Animated Wrinkle Maps", 2007.
// Techniques: wrinkle.maps.animation, wrinkle.maps.masks, wrinkle.maps.texture-set,
//     wrinkle.maps.weights

/// Weights of whole expressions, for artists.
enum class WrinklePreset : std::uint8_t {
    Neutral,
    Surprised,    ///< all of the stretched map
    Sour,         ///< all of the compressed map
    Disapproval,  ///< brows and lips compressed
    Frown,        ///< brows drawn together
    Smile,        ///< cheeks and the corners of the eyes compressed
    Pout,         ///< lips and chin compressed
};

inline constexpr const char* kWrinklePresetNames =
    "neutral surprised sour disapproval frown smile pout";

/// How far each region shows a wrinkle map: -1 the stretched one, 0 none, 1 the compressed one.
struct WrinkleWeights {
    WrinklePreset preset = WrinklePreset::Neutral;
    float left_brow = 0;
    float right_brow = 0;
    float middle_brow = 0;
    float lips = 0;
    float left_cheek = 0;
    float right_cheek = 0;
    float upper_left_cheek = 0;
    float upper_right_cheek = 0;
    float chin = 0;

    bool operator==(const WrinkleWeights&) const = default;
};

LIMN_FIELDS(WrinkleWeights) {
    LIMN_FIELD(
        preset, .doc = "weights of a whole expression, to which those of regions are added",
        .values = kWrinklePresetNames);
    LIMN_FIELD(left_brow, "red of first_masks", "", -1, 1);
    LIMN_FIELD(right_brow, "green of first_masks", "", -1, 1);
    LIMN_FIELD(middle_brow, "blue of first_masks", "", -1, 1);
    LIMN_FIELD(lips, "opacity of first_masks", "", -1, 1);
    LIMN_FIELD(left_cheek, "red of second_masks", "", -1, 1);
    LIMN_FIELD(right_cheek, "green of second_masks", "", -1, 1);
    LIMN_FIELD(upper_left_cheek, "blue of second_masks", "", -1, 1);
    LIMN_FIELD(upper_right_cheek, "opacity of second_masks", "", -1, 1);
    LIMN_FIELD(chin, "red of third_masks", "", -1, 1);
}

/// In the order of the channels of the masks.
inline constexpr std::array<float WrinkleWeights::*, 9> kWrinkleRegions = {
    &WrinkleWeights::left_brow,
    &WrinkleWeights::right_brow,
    &WrinkleWeights::middle_brow,
    &WrinkleWeights::lips,
    &WrinkleWeights::left_cheek,
    &WrinkleWeights::right_cheek,
    &WrinkleWeights::upper_left_cheek,
    &WrinkleWeights::upper_right_cheek,
    &WrinkleWeights::chin};

/// Shapes of a mesh with these names are channels of a clip that set the weights (see
/// wrinkle_track_system.h).
inline constexpr std::array<const char*, kWrinkleRegions.size()> kWrinkleChannels = {
    "wrinkle.left_brow",
    "wrinkle.right_brow",
    "wrinkle.middle_brow",
    "wrinkle.lips",
    "wrinkle.left_cheek",
    "wrinkle.right_cheek",
    "wrinkle.upper_left_cheek",
    "wrinkle.upper_right_cheek",
    "wrinkle.chin"};

/// Weights of the regions, -1 .. 1, with those of the preset; NaN counts as 0.
[[nodiscard]] std::array<float, kWrinkleRegions.size()>
region_weights(const WrinkleWeights& weights);

/// How two wrinkle maps and the skin's own normals are combined.
enum class WrinkleBlend : std::uint8_t {
    Lerp,    ///< towards each map in turn, then x and y are added and z multiplied (Oat)
    Slopes,  ///< slopes of all three add up: wrinkles as high as their influence, in any order
};

/// Whether both images have the same aspect ratio.
inline bool have_one_aspect(const ImageData& a, const ImageData& b) {
    return std::int64_t{a.width} * b.height == std::int64_t{a.height} * b.width;
}

/// Composes a normal map before each frame, for materials that use `target`. All images have one
/// uv set and one aspect ratio: with any other, nothing is composed.
struct WrinkleMaps {
    ImageId base = {};
    ImageId stretched = {};
    ImageId compressed = {};
    ImageId first_masks = {};
    ImageId second_masks = {};
    ImageId third_masks = {};
    ImageId target = {};  ///< rendered to; keeps its size and format
    WrinkleBlend blend = WrinkleBlend::Lerp;
};

LIMN_FIELDS(WrinkleMaps) {
    LIMN_FIELD(base, "normal map of skin without wrinkles, green up");
    LIMN_FIELD(stretched, "wrinkle map of skin that is stretched everywhere: weight -1");
    LIMN_FIELD(compressed, "wrinkle map of skin that is compressed everywhere: weight 1");
    LIMN_FIELD(first_masks, "masks of four regions, one per channel");
    LIMN_FIELD(second_masks, "four more; without it these have no effect");
    LIMN_FIELD(third_masks, "the chin, in red; without it there is none");
    LIMN_FIELD(target, "image to render to");
    LIMN_FIELD(
        blend, .doc = "normals interpolated and then added, or slopes added: higher in between",
        .values = "lerp slopes");
}

/// A keyframe of the weights.
struct WrinkleKey {
    float time = 0;
    WrinkleWeights weights;
};

LIMN_FIELDS(WrinkleKey) {
    LIMN_FIELD(time, "since the start of the level; greater than the previous key's", "s", 0, 1e6);
    visit_fields(self.weights, visit);
}

/// Moves the WrinkleWeights of its entity from key to key (wrinkle.maps.animation).
struct WrinkleTrack {
    std::vector<WrinkleKey> keys;
    bool smooth = true;
    bool loop = false;
};

LIMN_FIELDS(WrinkleTrack) {
    LIMN_FIELD(keys, "keyframes, in order of time");
    LIMN_FIELD(smooth, "eases in and out at keys; otherwise linear");
    LIMN_FIELD(loop, "starts over after the last key");
}

}  // namespace limn
