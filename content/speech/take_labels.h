#pragma once

#include "content/speech/speech_track.h"
#include "content/speech/wave_file.h"
#include "ecs/base/result.h"

#include <string>
#include <string_view>

namespace limn {

// When the sounds of a transcript are spoken in a recording (face.unit-generate): from labels that
// someone made by ear, or from the sound and the text. The
// track covers the recording from 0 on, with silence where the recording has some.

/// Labels as Audacity exports them, a line each: start and end [s], and a word of the transcript
/// or, if the first label is "sil", a sound, as "ae" (phonemes.h). Sounds of a word share its time
/// as in fluent speech; gaps are silence. Fails with "file:line: found X, expected Y".
[[nodiscard]] Result<SpeechTrack> parse_labels(
    std::string_view labels, const std::string& file, std::string_view text, float duration);

/// Without labels: phrases are what lies between the longest pauses, and their sounds are aligned
/// with what is heard there (word_alignment.h). Fails with one line when fewer stretches of sound
/// are audible than the text has phrases.
[[nodiscard]] Result<SpeechTrack> find_labels(const Recording& sound, std::string_view text);

}  // namespace limn
