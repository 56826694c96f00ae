#pragma once

#include "content/load/gltf/gltf_clip.h"
#include "content/speech/eyes.h"
#include "content/speech/mouth.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace limn {

// What a face's shapes have to do so that it speaks (face.talking-head): its channels are mouth,
// lids and gaze (face.categories), each driving the shapes of certain FACS action units. They add
// to an expression; where both move the mouth, speech wins (moves_mouth, mouth_left).

/// Something that a speaking face does; its strength is 0 .. 1.
enum class FaceChannel : std::uint8_t {
    JawOpen,
    MouthWide,
    MouthNarrow,
    LipsForward,
    LipsPressed,
    LipToTeeth,
    LidsShut,
    LookLeft,  ///< to the face's own left; 1: 40 degrees
    LookRight,
    LookUp,
    LookDown,
};

/// A shape that shows a channel: its weight is `gain` times the channel.
struct FaceLink {
    std::uint32_t shape = 0;
    FaceChannel channel = FaceChannel::JawOpen;
    float gain = 0.0f;
};

/// The shapes that speak, of every channel that they can show.
[[nodiscard]] std::vector<FaceLink> link_shapes(std::span<const GltfShape> shapes);

/// Whether one of the links opens the mouth, without which no face can speak.
[[nodiscard]] bool opens_mouth(std::span<const FaceLink> links);

/// Whether it is the shape of that name or action unit, or a half of it.
[[nodiscard]] bool is_shape(const GltfShape& shape, std::string_view name);

/// Whether the shape moves the mouth: action units 8, 10 to 20, 22 to 28, and 32 to 35.
[[nodiscard]] bool moves_mouth(const GltfShape& shape);

/// How much of an expression's share of the mouth speech leaves: 1 at rest, 0 where the mouth is
/// fully engaged.
[[nodiscard]] float mouth_left(const MouthPose& mouth);

/// Adds what the links make of mouth and eyes to `weights`, one per shape.
void add_face_weights(
    std::span<const FaceLink> links, const MouthPose& mouth, const EyePose& eyes,
    std::span<float> weights);

}  // namespace limn
