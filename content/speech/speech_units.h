#pragma once

#include "content/speech/resample.h"
#include "content/speech/speech_track.h"
#include "content/speech/wave_file.h"
#include "ecs/base/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace limn {

// Speech from recorded motion (face.speech-fragments): recordings with labels are cut into nested
// units, and an utterance is covered by as few of them as possible, since sounds that were spoken
// together already shape each other.

/// One recording: its text, timing, the motion of the face and the sound. `track` covers it from 0
/// on, with silence at both ends.
struct SpeechRecording {
    std::string text;
    SpeechTrack track;
    SampledCurves motion;
    std::string sound_file = {};  ///< .wav beside the library, or none
    Recording sound = {};         ///< without samples: none
};

enum class UnitKind : std::uint8_t {
    Sentence,  ///< all sounds of a recording
    Word,
    Diphone,  ///< from the center of one sound to the center of the next
};

/// A range of sounds of a recording; nothing is copied.
struct SpeechUnit {
    UnitKind kind = UnitKind::Sentence;
    std::uint32_t recording = 0;
    std::uint32_t first = 0;  ///< segment of the track
    std::uint32_t count = 0;
};

/// All units of all recordings (face.unit-generate): the sentence without its margins, its words,
/// and the diphones, including those with silence at the margins. A recording of p sounds and two
/// margins has p + 1 diphones.
[[nodiscard]] std::vector<SpeechUnit> generate_units(std::span<const SpeechRecording> recordings);

/// Time in the recording at which a unit starts or ends [s].
[[nodiscard]] float unit_start(const SpeechUnit& unit, const SpeechRecording& recording);
[[nodiscard]] float unit_end(const SpeechUnit& unit, const SpeechRecording& recording);

/// A unit that is used for sounds of an utterance, starting at segment `at` of its track.
struct SelectedUnit {
    SpeechUnit unit;
    std::uint32_t at = 0;
};

/// Covers the utterance by units (face.unit-select): the fewest joins, plus `join_cost` times the
/// distance between the poses at each join, by dynamic programming (A. Hunt and A. Black, "Unit
/// selection in a concatenative speech synthesis system", 1996). Silence needs no unit. Ties go to
/// the cover whose units come first in `units`. Fails with the missing sound or pair of sounds.
[[nodiscard]] Result<std::vector<SelectedUnit>> select_units(
    const SpeechTrack& target, std::span<const SpeechUnit> units,
    std::span<const SpeechRecording> recordings, float join_cost);

/// The motion of the utterance (face.align-resample, face.fragment-blend): each unit is stretched
/// so that its sounds align with those of `target`, and neighbors are blended over up to half a
/// sound on both sides of a join; where that is shorter than two samples, the second begins at the
/// end of the first and the difference fades out. At rest, 0, in silence without a unit.
[[nodiscard]] SampledCurves join_units(
    const SpeechTrack& target, std::span<const SelectedUnit> selected,
    std::span<const SpeechRecording> recordings, float rate);

}  // namespace limn
