#include "content/speech/face_clip.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

// Techniques: face.categories

namespace limn {

namespace {

constexpr float kFullGaze = 40.0f;  ///< degrees of an eye shape at weight 1

/// A shape by its name or action unit, with its weight for the full channel.
struct ClipCandidate {
    FaceChannel channel;
    std::string_view shape;
    float gain;
};

/// Per channel, the first that a face has is used. Gains scale full action units, which are
/// stronger than speech, to the motion of the mouth in speech (MouthAxis).
constexpr std::array kCandidates{
    ClipCandidate{FaceChannel::JawOpen, "AU27", 0.34f},  // 42 mm
    ClipCandidate{FaceChannel::JawOpen, "AU26", 0.9f},   // 15 mm
    ClipCandidate{FaceChannel::MouthWide, "AU20", 0.45f},
    ClipCandidate{FaceChannel::MouthWide, "AU12", 0.3f},
    ClipCandidate{FaceChannel::MouthNarrow, "AU18", 0.4f},
    ClipCandidate{FaceChannel::LipsForward, "AU22", 0.55f},
    ClipCandidate{FaceChannel::LipsForward, "AU18", 0.5f},
    ClipCandidate{FaceChannel::LipsPressed, "AU24", 0.25f},
    ClipCandidate{FaceChannel::LipsPressed, "AU23", 0.25f},
    ClipCandidate{FaceChannel::LipToTeeth, "mouthRollLower", 0.5f},
    ClipCandidate{FaceChannel::LipToTeeth, "AU32", 0.6f},
    ClipCandidate{FaceChannel::LidsShut, "AU45", 1.0f},
    ClipCandidate{FaceChannel::LidsShut, "AU43", 1.0f},
    ClipCandidate{FaceChannel::LookLeft, "AU61", 1.0f},
    ClipCandidate{FaceChannel::LookRight, "AU62", 1.0f},
    ClipCandidate{FaceChannel::LookUp, "AU63", 1.0f},
    ClipCandidate{FaceChannel::LookDown, "AU64", 1.0f},
};

float strength_of(FaceChannel channel, const MouthPose& mouth, const EyePose& eyes) {
    const auto axis = [&](MouthAxis which) { return mouth[static_cast<std::size_t>(which)]; };
    const float shut = std::clamp(axis(MouthAxis::LipsShut), 0.0f, 1.0f);
    switch (channel) {
    case FaceChannel::JawOpen:
        return axis(MouthAxis::Jaw) * (1.0f - shut);
    case FaceChannel::MouthWide:
        return std::max(axis(MouthAxis::Width), 0.0f);
    case FaceChannel::MouthNarrow:
        return std::max(-axis(MouthAxis::Width), 0.0f);
    case FaceChannel::LipsForward:
        return axis(MouthAxis::Protrusion);
    case FaceChannel::LipsPressed:
        return shut;
    case FaceChannel::LipToTeeth:
        return axis(MouthAxis::LipToTeeth);
    case FaceChannel::LidsShut:
        return eyes.closed;
    case FaceChannel::LookLeft:
        return std::max(eyes.yaw, 0.0f) / kFullGaze;
    case FaceChannel::LookRight:
        return std::max(-eyes.yaw, 0.0f) / kFullGaze;
    case FaceChannel::LookUp:
        return std::max(eyes.pitch, 0.0f) / kFullGaze;
    case FaceChannel::LookDown:
        return std::max(-eyes.pitch, 0.0f) / kFullGaze;
    }
    return 0.0f;
}

}  // namespace

bool is_shape(const GltfShape& shape, std::string_view name) {
    const auto is = [name](std::string_view found) {
        return found.starts_with(name)
               && (found.size() == name.size() || found.substr(name.size()) == "_L"
                   || found.substr(name.size()) == "_R");
    };
    return is(shape.name) || is(shape.action_unit);
}

std::vector<FaceLink> link_shapes(std::span<const GltfShape> shapes) {
    std::vector<FaceLink> links;
    for (const ClipCandidate& candidate : kCandidates) {
        const bool is_known = std::ranges::any_of(links, [&](const FaceLink& link) {
            return link.channel == candidate.channel
                   && !is_shape(shapes[link.shape], candidate.shape);
        });
        for (std::uint32_t i = 0; !is_known && i < shapes.size(); ++i) {
            if (is_shape(shapes[i], candidate.shape)) {
                links.push_back({i, candidate.channel, candidate.gain});
            }
        }
    }
    return links;
}

bool opens_mouth(std::span<const FaceLink> links) {
    return std::ranges::find(links, FaceChannel::JawOpen, &FaceLink::channel) != links.end();
}

bool moves_mouth(const GltfShape& shape) {
    constexpr std::string_view kPrefix = "AU";
    if (!shape.action_unit.starts_with(kPrefix)) {
        return false;
    }
    int unit = 0;
    const char* const digits = shape.action_unit.data() + kPrefix.size();
    std::from_chars(digits, shape.action_unit.data() + shape.action_unit.size(), unit);
    return unit == 8 || (unit >= 10 && unit <= 28 && unit != 21) || (unit >= 32 && unit <= 35);
}

float mouth_expression_weight(const MouthPose& mouth) {
    float engaged = 0.0f;
    for (const float axis : mouth) {
        engaged = std::max(engaged, std::abs(axis));
    }
    return 1.0f - std::min(engaged, 1.0f);
}

void add_face_weights(
    std::span<const FaceLink> links, const MouthPose& mouth, const EyePose& eyes,
    std::span<float> weights) {
    for (const FaceLink& link : links) {
        weights[link.shape] += link.gain * strength_of(link.channel, mouth, eyes);
    }
}

}  // namespace limn
