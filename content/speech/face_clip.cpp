#include "content/speech/face_clip.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

namespace limn {

namespace {

constexpr float kFullGaze = 40.0f;  ///< degrees of an eye shape at weight 1

/// A shape by its name or its action unit, with the weight at which it shows the channel fully.
struct Candidate {
    FaceChannel channel;
    std::string_view shape;
    float gain;
};

/// Of each channel the first that a face has. Gains make full action units, which are stronger than
/// speech, as large as the mouth moves in speech (MouthAxis).
constexpr std::array kCandidates{
    Candidate{FaceChannel::JawOpen, "AU27", 0.34f},  // 42 mm
    Candidate{FaceChannel::JawOpen, "AU26", 0.9f},   // 15 mm
    Candidate{FaceChannel::MouthWide, "AU20", 0.45f},
    Candidate{FaceChannel::MouthWide, "AU12", 0.3f},
    Candidate{FaceChannel::MouthNarrow, "AU18", 0.4f},
    Candidate{FaceChannel::LipsForward, "AU22", 0.55f},
    Candidate{FaceChannel::LipsForward, "AU18", 0.5f},
    Candidate{FaceChannel::LipsPressed, "AU24", 0.25f},
    Candidate{FaceChannel::LipsPressed, "AU23", 0.25f},
    Candidate{FaceChannel::LipToTeeth, "mouthRollLower", 0.5f},
    Candidate{FaceChannel::LipToTeeth, "AU32", 0.6f},
    Candidate{FaceChannel::LidsShut, "AU45", 1.0f},
    Candidate{FaceChannel::LidsShut, "AU43", 1.0f},
    Candidate{FaceChannel::LookLeft, "AU61", 1.0f},
    Candidate{FaceChannel::LookRight, "AU62", 1.0f},
    Candidate{FaceChannel::LookUp, "AU63", 1.0f},
    Candidate{FaceChannel::LookDown, "AU64", 1.0f},
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
    for (const Candidate& candidate : kCandidates) {
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

float mouth_left(const MouthPose& mouth) {
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
