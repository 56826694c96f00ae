#pragma once

#include "content/load/gltf/gltf_clip.h"
#include "content/speech/eyes.h"
#include "content/speech/mouth.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace limn {

// Drives the shapes of a face so that it speaks (face.talking-head): channels for mouth, lids and
// gaze (face.categories) each drive the shapes of certain FACS action units. They add to an
// expression; where both move the mouth, speech wins (moves_mouth, mouth_expression_weight).

/// A movement of a speaking face, with a strength of 0 .. 1.
enum class FaceChannel : std::uint8_t {
    JawOpen,
    MouthWide,
    MouthNarrow,
    LipsForward,
    LipsPressed,
    LipToTeeth,
    LidsShut,
    LookLeft,  ///< to the face's left; 1: 40 degrees
    LookRight,
    LookUp,
    LookDown,
};

/// A shape driven by a channel: its weight is `gain` times the channel.
struct FaceLink {
    std::uint32_t shape = 0;
    FaceChannel channel = FaceChannel::JawOpen;
    float gain = 0.0f;
};

/// Links from every channel to the shapes that can show it.
[[nodiscard]] std::vector<FaceLink> link_shapes(std::span<const GltfShape> shapes);

/// Whether one of the links opens the mouth, which a speaking face needs.
[[nodiscard]] bool opens_mouth(std::span<const FaceLink> links);

/// Whether the shape has that name or action unit, or is a half of it.
[[nodiscard]] bool is_shape(const GltfShape& shape, std::string_view name);

/// Whether the shape moves the mouth: action units 8, 10 to 20, 22 to 28, and 32 to 35.
[[nodiscard]] bool moves_mouth(const GltfShape& shape);

/// Weight that speech leaves to an expression of the mouth: 1 at rest, 0 where the mouth is fully
/// engaged.
[[nodiscard]] float mouth_expression_weight(const MouthPose& mouth);

/// Adds the pose of mouth and eyes to `weights`, one per shape, by the links.
void add_face_weights(
    std::span<const FaceLink> links, const MouthPose& mouth, const EyePose& eyes,
    std::span<float> weights);

}  // namespace limn
