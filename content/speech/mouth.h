#pragma once

#include "content/speech/coarticulation.h"
#include "content/speech/speech_track.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

/// Degrees of freedom of a speaking mouth.
enum class MouthAxis : std::uint8_t {
    Jaw,         ///< 0: closed, 1: widest in speech, 12 to 15 mm between the incisors
    Width,       ///< -1: corners 4 mm inward each, 1: outward
    Protrusion,  ///< of the lips; 1: 6 mm
    LipsShut,    ///< 1: closed regardless of the jaw
    LipToTeeth,  ///< 1: lower lip at the upper teeth
};

inline constexpr std::size_t kMouthAxes = 5;

/// Indexed by MouthAxis.
using MouthPose = std::array<float, kMouthAxes>;

/// The pose of each viseme (face.viseme) when held. Silence is the mouth at rest, 0.
[[nodiscard]] const MouthPose& mouth_of(Viseme viseme);

/// The targets of each axis in an utterance.
using MouthTrack = std::array<std::vector<DominanceTarget>, kMouthAxes>;

/// One target per segment, at its center. Rounding of the lips begins early; closures and the
/// margins of silence dominate.
[[nodiscard]] MouthTrack make_mouth_track(const SpeechTrack& track);

/// The pose at `time` [s]; at rest outside the track, and fading to rest within kSpeechMargin of
/// its ends.
[[nodiscard]] MouthPose mouth_at(const MouthTrack& track, float time);

}  // namespace limn
