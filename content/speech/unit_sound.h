#pragma once

#include "content/speech/speech_units.h"
#include "content/speech/wave_file.h"

#include <span>

namespace limn {

// The sound of speech from recorded fragments (face.speech-fragments). It keeps the pace at which
// its units were spoken, since stretched sound changes in pitch; the motion follows that pace.
// Units are cut at rising zero crossings, so that they meet in value and direction, and cross-faded
// there.

/// `target` at the pace of the units: each half of a sound lasts as long as it was recorded.
/// Silence lasts at most twice kSpeechMargin.
[[nodiscard]] SpeechTrack pace_by_units(
    const SpeechTrack& target, std::span<const SelectedUnit> selected,
    std::span<const SpeechRecording> recordings);

/// The joined sound for a track of that pace. Without samples where a recording in use has none, or
/// their rates differ.
[[nodiscard]] Recording join_sound(
    const SpeechTrack& target, std::span<const SelectedUnit> selected,
    std::span<const SpeechRecording> recordings);

}  // namespace limn
